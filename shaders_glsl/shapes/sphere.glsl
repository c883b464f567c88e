// Rays against spheres. A ray that leaves a sphere hits it again only from inside, at the far end
// of its chord.

// The distance along the ray, not above 0 for a miss. The formula is that of Haines et al. ("Precision
// Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019): the discriminant keeps the
// digits of r^2 for far origins, and neither root is a difference of nearly equal numbers.
float sphere_distance(Ray ray, Sphere sphere, int shape) {
    vec3 to_center = sphere.center - ray.origin;
    float along = dot(to_center, ray.direction);
    vec3 beside = to_center - along * ray.direction;
    float r2 = sphere.radius * sphere.radius;
    float discriminant = r2 - dot(beside, beside);
    if (shape == ray.origin_shape) {
        float chord = 2.0 * along;  // twice the way to its middle: along the rim, roots are only noise
        return ray.inward ? chord : 0.0;
    }
    if (discriminant <= 0.0) return 0.0;
    float half_chord = sqrt(discriminant);
    float q = along >= 0.0 ? along + half_chord : along - half_chord;
    float c = dot(to_center, to_center) - r2;
    float t = c / q;
    return t > 0.0 ? t : q;
}

Surface sphere_surface(vec3 p, int shape) {
    Sphere sphere = sphere_at(shape);
    vec3 normal = normalized(p - sphere.center);
    vec3 position = sphere.center + sphere.radius * normal;
    return Surface(position, normal, shape, sphere.material, sphere.light);
}
