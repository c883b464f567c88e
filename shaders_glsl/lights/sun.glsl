// The sun: a disc at infinity, sampled evenly over its solid angle.

// Whether a unit direction meets the sun. The difference of two directions keeps the digits of a small disc.
bool meets_sun(vec3 direction) {
    vec3 aside = direction - frame.sun_direction;
    return 0.5 * dot(aside, aside) <= frame.sun_versine;
}

float pdf_sun() {
    float pdf = 1.0 / (2.0 * PI * frame.sun_versine);
    return pdf;
}

// A sample of the sun from the origin of `ray`, whose direction is ignored.
LightSample sample_sun(Ray ray, inout Sampler rng) {
    vec2 u = next_2d(rng);
    vec3 local = sample_cone(frame.sun_versine, u);
    ray.direction = normalized(frame_around(frame.sun_direction) * local);
    return LightSample(ray, FAR, pdf_sun(), frame.sun_radiance, NO_SHAPE, SUN_LAYER, SUN_LIGHT);
}
