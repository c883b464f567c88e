// A ray against all shapes. No offsets and no tolerances, so a scene scaled by a power of two gives
// the same bits.

// The nearest shape nearer than `limit`, apart from the shape `ignored`; of two at the same
// distance the one with the lower number. With `any`, the first that is found.
Hit find_hit(Ray ray, float limit, int ignored, bool any) {
    precise Hit hit = Hit(limit, NO_SHAPE);
    if (HAS_TREE) {
        hit = find_sphere_by_tree(ray, hit, ignored, any);
        if (any && hit.shape != NO_SHAPE) return hit;
    } else if (HAS_SPHERE) {
        hit = find_sphere(ray, hit, ignored, any);
        if (any && hit.shape != NO_SHAPE) return hit;
    }
    if (HAS_PLANE) {
        hit = find_plane(ray, hit, any);
        if (any && hit.shape != NO_SHAPE) return hit;
    }
    if (HAS_QUAD) hit = find_quad(ray, hit, ignored, any);
    return hit;
}

float rays_so_far = 0.0;  // of this sample, where COUNT_RAYS

Hit closest_hit(Ray ray) {
    if (COUNT_RAYS) rays_so_far += 1.0;
    return find_hit(ray, FAR, NO_SHAPE, false);
}

// Whether anything but the lamp `ignored` stands within `limit`.
bool occluded(Ray ray, float limit, int ignored) {
    if (COUNT_RAYS) rays_so_far += 1.0;
    return find_hit(ray, limit, ignored, true).shape != NO_SHAPE;
}

// The point hit, put back onto the shape: the distance alone leaves it beside.
Surface surface_at(Ray ray, Hit hit) {
    precise vec3 p = ray.origin + hit.distance * ray.direction;
    if (HAS_SPHERE && up_to_sphere(hit.shape)) return sphere_surface(p, hit.shape);
    if (HAS_PLANE && up_to_plane(hit.shape)) return plane_surface(p, hit.shape);
    if (HAS_QUAD && up_to_quad(hit.shape)) return quad_surface(p, hit.shape);
    return no_surface();
}
