// Outputs of the first surface that a camera ray meets. A pass gathers one or two of them, FIRST_AOV
// and SECOND_AOV. It takes only whole observations, so that none is carried from dispatch to dispatch,
// except IN_PIECES: then it gathers one alone, sample by sample.

// The value of a sample that meets nothing. It is not finite, so add_sample leaves it out.
vec3 nothing_met() {
    return vec3(uintBitsToFloat(0x7F800000u));
}

// Albedo of a first surface. Glass takes no light: 1. Metal has its reflectance, a lamp its own albedo.
vec3 albedo_of(Material material) {
    if (material.kind == DIELECTRIC || material.kind == PANE) return vec3(1.0);
    return head_on_reflectance(material);
}

// Albedo and normal are 0 where a ray meets nothing. These samples count, as denoisers expect.
vec3 aov_of(int aov, Ray ray, Hit hit) {
    if (hit.shape == NO_SHAPE) return aov == DEPTH || aov == POSITION ? nothing_met() : vec3(0.0);
    Surface surface = surface_at(ray, hit);
    if (aov == ALBEDO) return albedo_of(material_of(ray, surface));
    if (aov == NORMAL) return dot(surface.normal, ray.direction) > 0.0 ? -surface.normal : surface.normal;
    if (aov == DEPTH) return vec3(dot(surface.position, frame.camera.forward));
    if (aov == POSITION) return surface.position;
    return nothing_met();
}

// 1 + the number of the object in the middle of the pixel, seen through the middle of the lens; 0 for none.
Pixel object_of(ivec2 place) {
    Ray ray = middle_ray(place);
    leave_vertex(0u, 0);  // one random number for all pixels: a partly transparent object is seen whole, or not at all
    Hit hit = MAY_PASS ? solid_hit(ray, FAR, NO_SHAPE, frame.camera_counts) : closest_hit(ray);
    Pixel pixel = empty_pixel();
    pixel.mean = vec3(hit.shape == NO_SHAPE ? 0.0 : float(1 + object_number(hit.shape)));
    pixel.count = 1.0;
    return pixel;
}

void add_aov(inout Pixel pixel, int aov, Ray ray, Hit hit, int index) {
    if (aov == NO_AOV || aov == OBJECT) return;
    add_sample(pixel, loop_was_cut ? nothing_met() : aov_of(aov, ray, hit), index);
}

// `place`: pixel in the full frame. The object is found when the film is empty and kept from then on.
void add_aovs(inout Pixel first, inout Pixel second, ivec2 place) {
    if (frame.is_empty != 0 && FIRST_AOV == OBJECT) first = object_of(place);
    if (frame.is_empty != 0 && SECOND_AOV == OBJECT) second = object_of(place);
    if (FIRST_AOV == OBJECT && SECOND_AOV == NO_AOV) return;
    int end = frame.first_sample + frame.sample_count;
    for (int index = frame.first_sample; index < end; index += 1) {
        Sampler rng = sampler_at(place, index, frame.seed);
        Ray ray = camera_ray(frame.camera, vec2(frame.size), vec2(place), rng);
        leave_vertex(rng.seed, 0);
        Hit hit = MAY_PASS ? solid_hit(ray, FAR, NO_SHAPE, frame.camera_counts) : closest_hit(ray);
        add_aov(first, FIRST_AOV, ray, hit, index);
        add_aov(second, SECOND_AOV, ray, hit, index);
    }
}
