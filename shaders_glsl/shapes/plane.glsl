// Rays against infinite planes. A flat shape is not hit again by a ray that leaves it.

// Infinite or NaN for a parallel ray: the comparisons in the callers reject both.
float plane_distance(Ray ray, vec3 point, vec3 normal) {
    float height = dot(point - ray.origin, normal);
    float approach = dot(ray.direction, normal);
    float t = height / approach;
    return t;
}

Surface plane_surface(vec3 p, int shape) {
    Plane plane = plane_at(shape - first_plane());
    vec3 position = p - dot(p - plane.point, plane.normal) * plane.normal;
    return Surface(position, plane.normal, shape, plane.material, NO_LIGHT);
}
