// Rays against the tree over bounded shapes. One loop reads a slot a round, as a node or as a leaf:
// a driver that computes both sides of a branch then waits for neither.

const uint LEAF = 0x80000000u;
const uint LINK = 0x0FFFFFFFu;

// Keeps a hit that is nearer, or as near and of a lower number.
Hit nearer(Hit hit, float t, int shape, int ignored) {
    bool is_first = t == hit.distance && shape < hit.shape;
    if (t > 0.0 && (t < hit.distance || is_first) && shape != ignored) hit = Hit(t, shape);
    return hit;
}

// The shape of a leaf; its packer: glrt/rendering/pack_tree.py.
Hit meet_leaf(Ray ray, ShearedRay turned, Slot slot, Hit hit, int ignored) {
    int kind = int(slot.d.w >> 28u & 7u);
    precise vec4 a = uintBitsToFloat(slot.a);
    precise vec4 b = uintBitsToFloat(slot.b);
    precise vec4 c = uintBitsToFloat(slot.c);
    precise vec3 d = uintBitsToFloat(slot.d.xyz);
    if (HAS_MESH && kind == TRIANGLES) {
        precise vec3 p = sheared_point(turned, a.xyz);
        precise vec3 q = sheared_point(turned, vec3(a.w, b.xy));
        precise vec3 r = sheared_point(turned, vec3(b.zw, c.x));
        precise vec3 s = sheared_point(turned, c.yzw);
        ivec2 triangles = first_triangle() + ivec2(slot.d.xy);
        precise float first = triangle_distance(p, q, r);
        if (triangles.x != ray.origin_shape) hit = nearer(hit, first, triangles.x, ignored);
        precise float second = triangle_distance(p, r, s);
        if (triangles.y != ray.origin_shape) hit = nearer(hit, second, triangles.y, ignored);
    }
    if (!HAS_TREE) return hit;
    int shape = int(slot.d.w & LINK);
    if (HAS_SPHERE && !HAS_SPHERE_TREE && kind == SPHERE) {
        precise float t = sphere_distance(ray, Sphere(a.xyz, a.w, 0, NO_LIGHT), shape);
        hit = nearer(hit, t, shape, ignored);
    }
    if (HAS_QUAD && kind == QUAD && shape != ray.origin_shape) {
        precise vec3 none = vec3(0.0);
        precise vec3 dual_u = vec3(b.zw, c.x);
        precise Quad quad = Quad(a.xyz, 0, vec3(a.w, b.xy), NO_LIGHT, none, 0.0, none, 0.0, dual_u, 0.0, c.yzw);
        precise float t = quad_distance(ray, quad);
        hit = nearer(hit, t, shape, ignored);
    }
    if (HAS_DISK && kind == DISK && shape != ray.origin_shape) {
        precise Disk disk = Disk(a.xyz, 0, vec3(a.w, b.xy), b.z, NO_LIGHT);
        precise float t = disk_distance(ray, disk);
        hit = nearer(hit, t, shape, ignored);
    }
    if (HAS_BOX && kind == BOX) {
        precise Box box = Box(a.xyz, 0, vec3(a.w, b.xy), b.z, vec3(b.w, c.xy), c.z, vec3(c.w, d.xy), d.z);
        precise float t = box_distance(ray, box, shape);
        hit = nearer(hit, t, shape, ignored);
    }
    if (HAS_CYLINDER && kind == CYLINDER) {
        precise Cylinder cylinder = Cylinder(a.xyz, 0, vec3(a.w, b.xy), b.z, b.w, int(slot.c.x));
        precise float t = cylinder_distance(ray, cylinder, shape);
        hit = nearer(hit, t, shape, ignored);
    }
    return hit;  // the nearest so far
}

void sort_pair(inout uint a, inout uint b) {
    uint less = min(a, b);
    b = max(a, b);
    a = less;
}

// The nearest shape nearer than hit.distance, or as near and of a lower number. Children are visited
// in the order in which the ray enters them. A stack entry, and `group`, list what is left of a node:
// how many children from bit 24 on, and their numbers, 3 bits each, the nearest first; beside it the
// slot of its first child.
Hit find_nearest_by_tree(Ray ray, Hit hit, int ignored) {
    precise TreeRay among = tree_ray(ray);
    precise ShearedRay turned = sheared(ray);
    precise TreeStack stack = empty_stack();
    int depth = 0;
    int place = 0;
    uvec2 group = uvec2(0u);
    bool going = slot_count() > 0;
    while (going) {
        precise Slot slot = slot_at(place);
        bool is_leaf = (slot.d.w & LEAF) != 0u;
        if (is_leaf) hit = meet_leaf(ray, turned, slot, hit, ignored);
        precise Children children = children_of(slot, among);
        precise float limit = hit.distance;
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
        bool pushes = keeps && group.y != 0u;
        push_if(pushes, group, stack);
        depth += pushes ? 1 : 0;
        uint first = slot.d.w & LINK;
        group = keeps ? uvec2(first, others << 24u | numbers) : group;
        bool pops = !enters && group.y == 0u;
        going = !pops || depth > 0;
        depth -= pops ? 1 : 0;
        group = pops ? stack.e0 : group;
        pop_if(pops, stack);
        uint many = group.y >> 24u;
        place = int(enters ? first + (k0 & 7u) : group.x + (group.y & 7u));
        uint rest = many > 1u ? (many - 1u) << 24u | (group.y & 0xFFFFFFu) >> 3u : 0u;
        group.y = enters ? group.y : rest;
    }
    if (going) loop_was_cut = true;
    return hit;
}

// Any shape nearer than hit.distance, in no order: a stack entry, and `group`, list what is left of a
// node by bits.
Hit find_any_by_tree(Ray ray, Hit hit, int ignored) {
    precise TreeRay among = tree_ray(ray);
    precise ShearedRay turned = sheared(ray);
    precise TreeStack stack = empty_stack();
    int depth = 0;
    int place = 0;
    uvec2 group = uvec2(0u);
    bool going = slot_count() > 0;
    while (going) {
        precise Slot slot = slot_at(place);
        bool is_leaf = (slot.d.w & LEAF) != 0u;
        if (is_leaf) hit = meet_leaf(ray, turned, slot, hit, ignored);
        precise Children children = children_of(slot, among);
        precise float limit = hit.distance;
        uint met = uint(meets_child(children, 0u, children.near_low, children.far_low, limit) != NO_CHILD)
                 | uint(meets_child(children, 1u, children.near_low, children.far_low, limit) != NO_CHILD) << 1u
                 | uint(meets_child(children, 2u, children.near_low, children.far_low, limit) != NO_CHILD) << 2u
                 | uint(meets_child(children, 3u, children.near_low, children.far_low, limit) != NO_CHILD) << 3u
                 | uint(meets_child(children, 4u, children.near_high, children.far_high, limit) != NO_CHILD) << 4u
                 | uint(meets_child(children, 5u, children.near_high, children.far_high, limit) != NO_CHILD) << 5u
                 | uint(meets_child(children, 6u, children.near_high, children.far_high, limit) != NO_CHILD) << 6u
                 | uint(meets_child(children, 7u, children.near_high, children.far_high, limit) != NO_CHILD) << 7u;
        bool enters = !is_leaf && met != 0u;
        bool pushes = enters && group.y != 0u;
        push_if(pushes, group, stack);
        depth += pushes ? 1 : 0;
        group = enters ? uvec2(slot.d.w & LINK, met) : group;
        bool pops = group.y == 0u;
        going = hit.shape == NO_SHAPE && (!pops || depth > 0);
        depth -= pops ? 1 : 0;
        group = pops ? stack.e0 : group;
        pop_if(pops, stack);
        place = int(group.x) + findLSB(group.y);
        group.y &= group.y - 1u;
    }
    if (going) loop_was_cut = true;
    return hit;
}
