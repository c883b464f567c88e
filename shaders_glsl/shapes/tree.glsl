// Rays against the tree over bounded shapes. A round reads one slot, as a node or as a leaf, since a driver may compute
// both sides of a branch. Where leaves hold several kinds of shapes, their tests take longer than a node: there the
// lanes that have found a leaf wait for the others.

// Loops over shapes that are constants take less time than a tree, even if its triangles are found by it.
const bool BY_TREE = HAS_TREE && !SHAPES_ARE_CONSTANT;

const uint LEAF = 0x80000000u;
const uint LINK = 0x07FFFFFFu;

// Keeps the new hit if it is nearer, or at the same distance with a lower number.
Hit nearer(Ray ray, Hit hit, float t, int shape, int ignored) {
    bool is_first = !HAS_COINCIDENT && t == hit.distance && shape < hit.shape;
    if (t > 0.0 && (is_nearer(ray, t, shape, hit) || is_first) && shape != ignored) hit = Hit(t, shape);
    return hit;
}

bool has_shape(Slot slot) { return (slot.d.w & LEAF) != 0u; }

int kind_of(Slot leaf) { return int(leaf.d.w >> 27u & 15u); }

int number_in(Slot leaf) { return int(leaf.d.w & LINK); }

// Tests the shape of a leaf; its packer: glrt/packing/shape_tree.py.
Hit meet_leaf(Ray ray, ShearedRay turned, int instance, Slot slot, Hit hit, int ignored) {
    int kind = kind_of(slot);
    vec4 a = uintBitsToFloat(slot.a);
    vec4 b = uintBitsToFloat(slot.b);
    vec4 c = uintBitsToFloat(slot.c);
    vec3 d = uintBitsToFloat(slot.d.xyz);
    if (HAS_MESH && kind == TRIANGLES) {
        vec3 p = sheared_point(turned, a.xyz);
        vec3 q = sheared_point(turned, vec3(a.w, b.xy));
        vec3 r = sheared_point(turned, vec3(b.zw, c.x));
        vec3 s = sheared_point(turned, c.yzw);
        ivec2 triangles = first_triangle() + ivec2(slot.d.xy);
        if (HAS_INSTANCE) triangles += instance << INSTANCE_BITS;
        float first = triangle_distance(p, q, r);
        if (HAS_HIDDEN_BACK && meets_hidden(turned, p, q, r, slot.d.z & 3u)) first = 0.0;
        if (triangles.x != ray.origin_shape) hit = nearer(ray, hit, first, triangles.x, ignored);
        float second = triangle_distance(p, r, s);
        if (HAS_HIDDEN_BACK && meets_hidden(turned, p, r, s, slot.d.z >> 2u)) second = 0.0;
        if (triangles.y != ray.origin_shape) hit = nearer(ray, hit, second, triangles.y, ignored);
    }
    if (!BY_TREE) return hit;
    int shape = number_in(slot);
    if (HAS_SPHERE && !HAS_SPHERE_TREE && kind == SPHERE) {
        float t = sphere_distance(ray, Sphere(a.xyz, a.w, 0, NO_LIGHT), shape);
        hit = nearer(ray, hit, t, shape, ignored);
    }
    if (HAS_QUAD && kind == QUAD && shape != ray.origin_shape) {
        vec3 none = vec3(0.0);
        vec3 dual_u = vec3(b.zw, c.x);
        Quad quad = Quad(a.xyz, 0, vec3(a.w, b.xy), NO_LIGHT, none, 0.0, none, 0.0, dual_u, 0.0, c.yzw);
        float t = quad_distance(ray, quad);
        hit = nearer(ray, hit, t, shape, ignored);
    }
    if (HAS_DISK && kind == DISK && shape != ray.origin_shape) {
        Disk disk = Disk(a.xyz, 0, vec3(a.w, b.xy), b.z, NO_LIGHT);
        float t = disk_distance(ray, disk);
        hit = nearer(ray, hit, t, shape, ignored);
    }
    if (HAS_BOX && kind == BOX) {
        Box box = Box(a.xyz, 0, vec3(a.w, b.xy), b.z, vec3(b.w, c.xy), c.z, vec3(c.w, d.xy), d.z);
        float t = box_distance(ray, box, shape);
        hit = nearer(ray, hit, t, shape, ignored);
    }
    if (HAS_CYLINDER && kind == CYLINDER) {
        Cylinder cylinder = Cylinder(a.xyz, 0, vec3(a.w, b.xy), b.z, b.w, int(slot.c.x));
        float t = cylinder_distance(ray, cylinder, shape);
        hit = nearer(ray, hit, t, shape, ignored);
    }
    return hit;  // the nearest so far
}

void sort_pair(inout uint a, inout uint b) {
    uint less = min(a, b);
    b = max(a, b);
    a = less;
}

// The part of a tree that is left to visit. A stack entry, and `group`, contain the slot of the first child of a node
// and a list of its children that are left.
struct Walk {
    TreeStack stack;
    int depth;
    int place;  // the next slot
    uvec2 group;
    bool goes_on;
    bool goes_in;     // whether the next slot is in the tree of an instance
    bool gets_out;    // whether the walk leaves that tree, if it is in one
    int depth_there;  // depth of the stack when the walk entered the instance
};

Walk walk_from_root() {
    return Walk(empty_stack(), 0, 0, uvec2(0u), slot_count() > 0, false, false, 0);
}

// A ray among the slots of a tree.
struct Course {
    TreeRay grid;
    ShearedRay turned;
    int instance;  // the instance of that tree; 0: the tree of the scene
};

// The largest distance from the start of the course at which a shape may replace a hit. Distances of hits are rounded
// relative to the skipped part.
float limit_of(Ray ray, Course course, Hit hit) {
    float skipped = course.turned.skipped;
    float limit = (farthest(ray, hit) - skipped) + SLACK * skipped;
    return limit;
}

// Visits a slot on the way to the nearest shape nearer than hit.distance, or at the same distance with a lower
// number. Children are visited in the order in which the ray enters them. `group` contains the number of children
// left, from bit 24 on, and the numbers of these children, 3 bits each, the nearest first.
void visit_nearest(Ray ray, Course course, Slot slot, int ignored, inout Walk walk, inout Hit hit) {
    bool is_leaf = has_shape(slot);
    if (!BY_TREE && is_leaf) hit = meet_leaf(ray, course.turned, course.instance, slot, hit, ignored);
    Children children = children_of(slot, course.grid);
    float limit = limit_of(ray, course, hit);
    uint k0 = meets_child(children, 0u, children.near_low, children.far_low, limit);
    uint k1 = meets_child(children, 1u, children.near_low, children.far_low, limit);
    uint k2 = meets_child(children, 2u, children.near_low, children.far_low, limit);
    uint k3 = meets_child(children, 3u, children.near_low, children.far_low, limit);
    uint k4 = meets_child(children, 4u, children.near_high, children.far_high, limit);
    uint k5 = meets_child(children, 5u, children.near_high, children.far_high, limit);
    uint k6 = meets_child(children, 6u, children.near_high, children.far_high, limit);
    uint k7 = meets_child(children, 7u, children.near_high, children.far_high, limit);
    sort_pair(k0, k2); sort_pair(k1, k3); sort_pair(k4, k6); sort_pair(k5, k7);
    sort_pair(k0, k4); sort_pair(k1, k5); sort_pair(k2, k6); sort_pair(k3, k7);
    sort_pair(k0, k1); sort_pair(k2, k3); sort_pair(k4, k5); sort_pair(k6, k7);
    sort_pair(k2, k4); sort_pair(k3, k5); sort_pair(k1, k4); sort_pair(k3, k6);
    sort_pair(k1, k2); sort_pair(k3, k4); sort_pair(k5, k6);
    uint others = uint(k1 != NO_CHILD) + uint(k2 != NO_CHILD) + uint(k3 != NO_CHILD) + uint(k4 != NO_CHILD)
                + uint(k5 != NO_CHILD) + uint(k6 != NO_CHILD) + uint(k7 != NO_CHILD);
    uint numbers = k1 & 7u | (k2 & 7u) << 3u | (k3 & 7u) << 6u | (k4 & 7u) << 9u | (k5 & 7u) << 12u
                 | (k6 & 7u) << 15u | (k7 & 7u) << 18u;
    bool enters = !is_leaf && k0 != NO_CHILD;
    bool keeps = enters && others > 0u;
    walk.goes_in = HAS_INSTANCE && is_leaf && kind_of(slot) == INSTANCE;
    bool pushes = (keeps || walk.goes_in) && walk.group.y != 0u;
    push_if(pushes, walk.group, walk.stack);
    walk.depth += pushes ? 1 : 0;
    uint first = slot.d.w & LINK;
    walk.group = keeps ? uvec2(first, others << 24u | numbers) : walk.group;
    if (HAS_INSTANCE) {
        walk.group = walk.goes_in ? uvec2(slot.d.x, 1u << 24u) : walk.group;
        walk.depth_there = walk.goes_in ? walk.depth : walk.depth_there;
    }
    bool pops = !enters && walk.group.y == 0u;
    walk.gets_out = HAS_INSTANCE && pops && walk.depth == walk.depth_there;
    walk.goes_on = !pops || walk.depth > 0;
    walk.depth -= pops ? 1 : 0;
    walk.group = pops ? walk.stack.e0 : walk.group;
    pop_if(pops, walk.stack);
    uint many = walk.group.y >> 24u;
    walk.place = int(enters ? first + (k0 & 7u) : walk.group.x + (walk.group.y & 7u));
    uint rest = many > 1u ? (many - 1u) << 24u | (walk.group.y & 0xFFFFFFu) >> 3u : 0u;
    walk.group.y = enters ? walk.group.y : rest;
}

// Visits a slot on the way to any shape nearer than hit.distance, in no order: `group` lists children by bits.
void visit_any(Ray ray, Course course, Slot slot, int ignored, inout Walk walk, inout Hit hit) {
    bool is_leaf = has_shape(slot);
    if (!BY_TREE && is_leaf) hit = meet_leaf(ray, course.turned, course.instance, slot, hit, ignored);
    Children children = children_of(slot, course.grid);
    float limit = limit_of(ray, course, hit);
    uint met = uint(meets_child(children, 0u, children.near_low, children.far_low, limit) != NO_CHILD)
             | uint(meets_child(children, 1u, children.near_low, children.far_low, limit) != NO_CHILD) << 1u
             | uint(meets_child(children, 2u, children.near_low, children.far_low, limit) != NO_CHILD) << 2u
             | uint(meets_child(children, 3u, children.near_low, children.far_low, limit) != NO_CHILD) << 3u
             | uint(meets_child(children, 4u, children.near_high, children.far_high, limit) != NO_CHILD) << 4u
             | uint(meets_child(children, 5u, children.near_high, children.far_high, limit) != NO_CHILD) << 5u
             | uint(meets_child(children, 6u, children.near_high, children.far_high, limit) != NO_CHILD) << 6u
             | uint(meets_child(children, 7u, children.near_high, children.far_high, limit) != NO_CHILD) << 7u;
    bool enters = !is_leaf && met != 0u;
    walk.goes_in = HAS_INSTANCE && is_leaf && kind_of(slot) == INSTANCE;
    bool pushes = (enters || walk.goes_in) && walk.group.y != 0u;
    push_if(pushes, walk.group, walk.stack);
    walk.depth += pushes ? 1 : 0;
    walk.group = enters ? uvec2(slot.d.w & LINK, met) : walk.group;
    if (HAS_INSTANCE) {
        walk.group = walk.goes_in ? uvec2(slot.d.x, 1u) : walk.group;
        walk.depth_there = walk.goes_in ? walk.depth : walk.depth_there;
    }
    bool pops = walk.group.y == 0u;
    walk.gets_out = HAS_INSTANCE && pops && walk.depth == walk.depth_there;
    walk.goes_on = hit.shape == NO_SHAPE && (!pops || walk.depth > 0);
    walk.depth -= pops ? 1 : 0;
    walk.group = pops ? walk.stack.e0 : walk.group;
    pop_if(pops, walk.stack);
    walk.place = int(walk.group.x) + findLSB(walk.group.y);
    walk.group.y &= walk.group.y - 1u;
}

// Visits a slot. Its shape, if it has one, is not tested yet.
void visit(Ray ray, Course course, Slot slot, int ignored, bool any, inout Walk walk, inout Hit hit) {
    if (any) visit_any(ray, course, slot, ignored, walk, hit);
    else visit_nearest(ray, course, slot, ignored, walk, hit);
}

// A ray in the frame of a tree: the data that a course is computed from.
struct Among {
    vec3 start;  // relative to the middle of the grid
    vec3 clear;  // the same, moved off the triangle that the ray leaves
    vec3 direction;
    float largest;  // the rounding of coordinates is relative to it
    float cell;
    int instance;
};

Among outside_instances(Ray ray, Start start) {
    vec3 clear = start_among_triangles(ray, start.place);
    return Among(start.place, clear, ray.direction, start.largest, frame.tree_cell, 0);
}

// The ray in the next tree: where the walk enters an instance, stays in its tree, or leaves it. All cases are
// computed. The choice is made among few values, from which the rest follows.
Among next_among(Among now, Among outside, Walk walk, Slot slot, Left left) {
    Inward inward = inward_at(slot);
    vec3 start = turned_in(inward, outside.start - inward.origin);
    vec3 direction = turned_in(inward, outside.direction);
    float largest = uintBitsToFloat(slot.d.y) * (outside.largest + inward.reach);
    int instance = number_in(slot);
    vec3 clear = instance == left.instance ? start + left.shift : start;
    bool goes_in = walk.goes_in;
    bool gets_out = walk.gets_out && now.instance > 0;
    return Among(
        goes_in ? start : gets_out ? outside.start : now.start,
        goes_in ? clear : gets_out ? outside.clear : now.clear,
        goes_in ? direction : gets_out ? outside.direction : now.direction,
        goes_in ? largest : gets_out ? outside.largest : now.largest,
        goes_in ? 1.0 : gets_out ? outside.cell : now.cell,
        goes_in ? instance : gets_out ? 0 : now.instance);
}

Course course_of(Among among, float skipped) {
    float cells = 1.0 / among.cell;
    float largest = among.largest * cells;
    TreeRay grid = ray_on_grid(among.start * cells, largest, INSTANCE_SLACK, among.direction, among.cell);
    return Course(grid, sheared_along(among.clear, among.direction, skipped), among.instance);
}

Hit find_by_tree(Ray ray, Hit hit, int ignored, bool any) {
    Start start = start_of(ray);
    Course course = Course(tree_ray(start, ray.direction), sheared_from(start, ray), 0);
    Among outside = outside_instances(ray, start);
    Among among = outside;
    Left left = left_by(ray);
    Walk walk = walk_from_root();
    while (walk.goes_on) {
        Slot slot;
        if (BY_TREE) {
            bool seeks = true;
            while (seeks) {
                slot = slot_at(walk.place);
                visit(ray, course, slot, ignored, any, walk, hit);
                seeks = walk.goes_on && !has_shape(slot) && !walk.gets_out;
            }
            if (has_shape(slot)) hit = meet_leaf(ray, course.turned, course.instance, slot, hit, ignored);
            if (any) walk.goes_on = walk.goes_on && hit.shape == NO_SHAPE;
        } else {
            slot = slot_at(walk.place);
            visit(ray, course, slot, ignored, any, walk, hit);
        }
        if (HAS_INSTANCE) {
            among = next_among(among, outside, walk, slot, left);
            course = course_of(among, start.skipped);
        }
    }
    if (walk.goes_on) loop_was_cut = true;
    return hit;
}
