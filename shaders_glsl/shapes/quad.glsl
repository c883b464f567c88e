// Rays against parallelograms.

float quad_distance(Ray ray, Quad quad) {
    float t = plane_distance(ray, quad.corner, quad.normal);
    vec3 p = ray.origin + t * ray.direction - quad.corner;
    float u = dot(quad.dual_u, p);
    float v = dot(quad.dual_v, p);
    bool inside = u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0;
    return inside ? t : 0.0;
}

Surface quad_surface(vec3 p, int shape) {
    Quad quad = quad_at(shape - first_quad());
    vec3 position = p - dot(p - quad.corner, quad.normal) * quad.normal;
    return Surface(position, quad.normal, shape, quad.material, quad.light);
}
