// Rays against the tree over the spheres (glrt/bvh.py). Its nodes lie in depth-first order and
// say where to go on when a ray misses them, so a ray needs no stack.
//
// The picture is that of the loop over all spheres, bit for bit: a box only says what may be left
// out, and it is wide enough for the rounding of sphere_distance and of its own test.

// How far the origin of a ray is taken to lie off, relative to its largest coordinate: 64 times
// the rounding of a float. Boxes are as wide for the rounding of their own corners.
const float SLACK = 3.814697265625e-6;

struct Slab {
    vec3 above;    // the origin, moved up and down by its slack
    vec3 below;
    vec3 inverse;  // of the direction, finite: 0 times it is 0
};

Slab slab_of(Ray ray) {
    vec3 size = abs(ray.origin);
    float slack = SLACK * max(size.x, max(size.y, size.z));
    vec3 above = ray.origin + slack;
    vec3 below = ray.origin - slack;
    vec3 inverse = clamp(1.0 / ray.direction, vec3(-FAR), vec3(FAR));
    return Slab(above, below, inverse);
}

// Whether the ray may meet the box before `limit`.
bool meets_box(Slab slab, Node node, float limit) {
    vec3 a = (node.lower - slab.above) * slab.inverse;
    vec3 b = (node.upper - slab.below) * slab.inverse;
    vec3 first = min(a, b);
    vec3 last = max(a, b);
    float enters = max(max(first.x, first.y), max(first.z, 0.0));
    float leaves = min(min(last.x, last.y), min(last.z, limit));
    return enters <= leaves;
}

// Without its material, which is that of sphere_at(node.sphere).
Sphere leaf_sphere(Node node) {
    return Sphere(node.lower, node.upper.x, 0, NO_LIGHT);
}

// The nearest sphere nearer than hit.distance, as find_hit has it.
Hit find_sphere(Ray ray, Hit hit, int ignored, bool any) {
    Slab slab = slab_of(ray);
    int place = 0;
    while (place < node_count()) {
        Node node = node_at(place);
        bool is_leaf = node.sphere != NO_SHAPE;
        place = is_leaf || meets_box(slab, node, hit.distance) ? place + 1 : node.skip;
        if (!is_leaf || node.sphere == ignored) continue;
        float t = sphere_distance(ray, leaf_sphere(node), node.sphere);
        bool is_first = t == hit.distance && node.sphere < hit.shape;
        if (t > 0.0 && (t < hit.distance || is_first)) {
            hit = Hit(t, node.sphere);
            if (any) return hit;
        }
    }
    note_end(place, node_count());
    return hit;
}
