// Surfaces that are there in part, or have holes: light passes where a hashed number is not below the coverage.
// The number is of the sample, of the vertex that the segment leaves, and of how many surfaces it has passed: not of
// the order in which a tree is searched. A hole costs no bounce, and rays to lamps pass it by the same rule.

const uint MOST_HOLES = 1024u;  // of a segment: what lies behind more is not seen

// `passed`: holes of this segment so far.
bool is_hole(Material material, uint passed) {
    if (material.kind != PRINCIPLED || material.coverage >= 1.0 || passed >= MOST_HOLES) return false;
    return hole_number(passed) >= material.coverage;
}

Ray beyond(Ray ray, Surface surface) {
    bool enters = dot(ray.direction, true_normal(surface)) < 0.0;
    return Ray(surface.position, ray.direction, surface.shape, enters);
}

// The nearest surface that is no hole, seen from `ray`, which then starts at the last hole before it.
Hit solid_hit(precise inout Ray ray, float limit, int ignored) {
    uint passed = 0u;
    for (; passed <= MOST_HOLES; passed += 1u) {
        precise Hit hit = find_hit(ray, limit, ignored, false);
        if (hit.shape == NO_SHAPE) return hit;
        precise Surface surface = surface_at(ray, hit);
        if (!is_hole(material_of(ray, surface), passed)) return hit;
        if (limit < FAR) limit -= hit.distance;
        ray = beyond(ray, surface);
    }
    note_end(int(passed), int(MOST_HOLES) + 2);
    return Hit(limit, NO_SHAPE);
}

// Whether a flat lamp is what a ray to it sees, in a place that it may share.
bool shows(Ray ray, int lamp) {
    if (!HAS_HOLE) return find_hit(ray, FAR, NO_SHAPE, false).shape == lamp;
    precise Ray seen = ray;
    return solid_hit(seen, FAR, NO_SHAPE).shape == lamp;
}

// Whether anything but the shape `ignored`, a lamp or what a link passes, stands within `limit`.
bool occluded(Ray ray, float limit, int ignored) {
    if (COUNT_RAYS) rays_so_far += 1.0;
    if (HAS_COINCIDENT && ignored != NO_SHAPE && !(HAS_SPHERE && up_to_sphere(ignored))) return !shows(ray, ignored);
    if (!HAS_HOLE) return find_hit(ray, limit, ignored, true).shape != NO_SHAPE;
    precise Ray seen = ray;
    return solid_hit(seen, limit, ignored).shape != NO_SHAPE;
}
