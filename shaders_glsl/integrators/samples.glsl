// The samples that one dispatch adds to one pixel.

Path camera_path(ivec2 place, inout Sampler rng) {
    Path path = start_path(camera_ray(frame.camera, vec2(frame.size), vec2(place), rng));
    if (HAS_GRID) start_collisions(rng.seed);
    if (HAS_MEDIA) begin_flight(path.flight, path.throughput, rng);
    return path;
}

// Count of rays of a sample, which replaces radiance where COUNT_RAYS.
vec3 rays_of_sample() {
    vec3 rays = vec3(rays_so_far);
    rays_so_far = 0.0;
    return rays;
}

// The value that a sample adds: its radiance, its count of rays, or its count of scattering events.
vec3 value_of(Path path) {
    if (COUNT_RAYS) return rays_of_sample();
    return COUNT_BOUNCES ? vec3(float(path.depth)) : path.radiance;
}

// One loop over the segments of all paths: a lane whose path has ended starts its next sample at
// once and does not wait for its neighbours. `place`: pixel in the full frame; `first`: number of its
// next sample. Returns how many samples are lost because the driver ended a loop early: this loop, or
// one of a ray.
int add_samples(inout Pixel pixel, inout Layers layers, ivec2 place, int first) {
    int index = first;
    int end = index + frame.sample_count;
    Sampler rng = sampler_at(place, index, frame.seed);
    Path path = camera_path(place, rng);
    start_resampling(rng);
    while (index < end) {
        if (extend_path(path, rng)) continue;
        if (MODEL == WHITTED_TREE && !loop_was_cut && take_branch(path)) continue;
        if (loop_was_cut) break;
        end_resampling(path, place, index);
        add_sample(pixel, value_of(path), index);
        if (LAYERS > 0) add_layers(layers, path, index);
        if (LIGHT_TERMS != 0) add_terms(path, index);
        index += 1;
        rng = sampler_at(place, index, frame.seed);
        path = camera_path(place, rng);
        start_resampling(rng);
    }
    drop_samples(pixel, index, end);
    if (LIGHT_TERMS != 0) drop_from_terms(index, end);
    return end - index;
}

int add_samples(inout Pixel pixel, ivec2 place) {
    Layers none = empty_layers();
    return add_samples(pixel, none, place, frame.first_sample);
}
