// Surfaces that are partly there, have holes, or only bound a volume: light passes where a hashed number is not below the coverage.
// The number depends on the sample, on the vertex that the segment leaves, and on how many surfaces it has passed. It
// does not depend on the order in which a tree is searched. A hole costs no bounce, and rays to lamps follow the same
// rule. They pass the surface of glass that gives way to other glass, too.

const bool MAY_PASS = HAS_HOLE || HAS_RANKS;
const uint MOST_HOLES = 1024u;  // of a segment: surfaces behind more holes are not seen

// `passed`: holes of this segment so far.
bool is_hole(Material material, uint passed) {
    if (passed >= MOST_HOLES) return false;
    if (HAS_NONE && material.kind == NONE) return true;
    if (material.kind != PRINCIPLED || material.coverage >= 1.0) return false;
    return hole_number(passed) >= material.coverage;
}

// Whether light passes the surface of an object where these volumes overlap.
bool is_passed(Material material, uint passed, uint volumes, int object) {
    if (is_hole(material, passed)) return true;
    return HAS_RANKS && passed < MOST_HOLES && is_displaced(volumes, object);
}

Ray beyond(Ray ray, Surface surface) {
    bool enters = dot(ray.direction, true_normal(surface)) < 0.0;
    return Ray(surface.position, ray.direction, surface.shape, enters);
}

// The nearest surface that is no hole, seen from `ray`. Afterwards the ray starts at the last hole before that surface.
// `volumes`: around the start.
Hit solid_hit(inout Ray ray, float limit, int ignored, uint volumes) {
    int medium = 0;
    uint passed = 0u;
    for (; passed <= MOST_HOLES; passed += 1u) {
        Hit hit = find_hit(ray, limit, ignored, false);
        if (hit.shape == NO_SHAPE) return hit;
        Surface surface = surface_at(ray, hit);
        if (!is_passed(material_of(ray, surface), passed, volumes, object_number(surface.shape))) return hit;
        if (limit < FAR) limit -= hit.distance;
        ray = beyond(ray, surface);
        if (HAS_RANKS) cross_bounds(medium, volumes, object_number(surface.shape), ray.inward);
    }
    note_end(int(passed), int(MOST_HOLES) + 2);
    return Hit(limit, NO_SHAPE);
}

// Whether a ray to a flat lamp sees that lamp, in a place that it may share with other surfaces.
bool shows(Ray ray, int lamp) {
    if (!HAS_HOLE) return find_hit(ray, FAR, NO_SHAPE, false).shape == lamp;
    Ray seen = ray;
    return solid_hit(seen, FAR, NO_SHAPE, 0u).shape == lamp;
}

// Whether a shape other than `ignored` stands within `limit`. That is a lamp, or a shape that a link passes.
bool occluded(Ray ray, float limit, int ignored) {
    if (COUNT_RAYS) rays_so_far += 1.0;
    if (HAS_COINCIDENT && ignored != NO_SHAPE && !(HAS_SPHERE && up_to_sphere(ignored))) return !shows(ray, ignored);
    if (!HAS_HOLE) return find_hit(ray, limit, ignored, true).shape != NO_SHAPE;
    Ray seen = ray;
    return solid_hit(seen, limit, ignored, 0u).shape != NO_SHAPE;
}
