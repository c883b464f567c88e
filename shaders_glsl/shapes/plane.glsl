// Rays against infinite planes. A flat shape is not hit again by a ray that leaves it.

// Infinite or NaN for a parallel ray: no comparison below lets that pass.
float plane_distance(Ray ray, vec3 point, vec3 normal) {
    precise float height = dot(point - ray.origin, normal);
    precise float approach = dot(ray.direction, normal);
    precise float t = height / approach;
    return t;
}

Hit find_plane(Ray ray, Hit hit, bool any) {
    int i = 0;
    for (; i < plane_count(); ++i) {
        int shape = first_plane() + i;
        precise Plane plane = plane_at(i);
        precise float t = plane_distance(ray, plane.point, plane.normal);
        if (t > 0.0 && t < hit.distance && shape != ray.origin_shape) {
            hit = Hit(t, shape);
            if (any) return hit;
        }
    }
    note_end(i, plane_count());
    return hit;
}

Surface plane_surface(vec3 p, int shape) {
    precise Plane plane = plane_at(shape - first_plane());
    precise vec3 position = p - dot(p - plane.point, plane.normal) * plane.normal;
    return Surface(position, plane.normal, shape, plane.material, NO_LIGHT);
}
