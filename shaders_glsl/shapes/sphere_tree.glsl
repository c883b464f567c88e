// Rays against the tree over the spheres (glrt/accel/sphere_nodes.py). Its nodes lie in depth-first order and
// say where to go on when a ray misses them, so a ray needs no stack.
//
// The picture has the same bits as with the loop over all spheres. A box only says which spheres may be
// left out, and it is wide enough for the rounding of sphere_distance and of its own test.

// Assumed error of the origin of a ray, relative to its largest coordinate or that of the grid's corner: 64 times
// the rounding of a float. Boxes are wide enough for the rounding of their own corners.
const float SPHERE_SLACK = 3.814697265625e-6;

// A ray among the cells of the grid.
struct Slab {
    vec3 above;    // the origin, moved up by its slack
    vec3 below;
    vec3 inverse;  // of the direction, finite, so that 0 times it is 0
};

// `grid`: the corner of the grid, and the edge of a cell, a power of two.
Slab slab_of(Ray ray, vec4 grid) {
    vec3 size = max(abs(ray.origin), abs(grid.xyz));
    float slack = SPHERE_SLACK * max(size.x, max(size.y, size.z));
    float cells = 1.0 / grid.w;  // computed here, because compilers would compute it again at every node
    vec3 above = (ray.origin + slack - grid.xyz) * cells;
    vec3 below = (ray.origin - slack - grid.xyz) * cells;
    vec3 inverse = clamp(grid.w / ray.direction, vec3(-FAR), vec3(FAR));
    return Slab(above, below, inverse);
}

// Whether the ray may meet the box of a node before `limit`.
bool meets_box(Slab slab, uvec3 box, float limit) {
    vec3 lower = vec3(ivec3(box & 0xFFFFu));
    vec3 upper = vec3(ivec3(box >> 16u));
    vec3 a = (lower - slab.above) * slab.inverse;
    vec3 b = (upper - slab.below) * slab.inverse;
    vec3 first = vec3(lesser(a.x, b.x), lesser(a.y, b.y), lesser(a.z, b.z));
    vec3 last = vec3(larger(a.x, b.x), larger(a.y, b.y), larger(a.z, b.z));
    float enters = larger(larger(first.x, first.y), larger(first.z, 0.0));
    float leaves = lesser(lesser(last.x, last.y), lesser(last.z, limit));
    return enters <= leaves;
}

// The sphere of a node without its material, which sphere_at has.
Sphere sphere_of(Node node) {
    vec4 place = uintBitsToFloat(node.sphere);
    return Sphere(place.xyz, place.w, 0, NO_LIGHT);
}

// The nearest sphere nearer than hit.distance, with the parameters of find_hit. The box is tested first: a nearer hit
// of the node's sphere could shorten the search, but to wait for this hit costs more than it saves.
Hit find_sphere_by_tree(Ray ray, Hit hit, int ignored, bool any) {
    Slab slab = slab_of(ray, uintBitsToFloat(node_at(0).sphere));
    int end = node_count();  // read once
    int place = 1;
    while (place < end) {
        Node node = node_at(place);
        int below = int(node.box.w >> 16u);
        int shape = int(node.box.w & 0xFFFFu);
        place += meets_box(slab, node.box.xyz, hit.distance) ? 1 : 1 + below;
        float t = sphere_distance(ray, sphere_of(node), shape);
        bool is_first = t == hit.distance && shape < hit.shape;
        if (t > 0.0 && (t < hit.distance || is_first) && shape != ignored) {
            hit = Hit(t, shape);
            if (any) return hit;
        }
    }
    note_end(place, end);
    return hit;
}
