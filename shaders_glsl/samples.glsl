// The samples that one dispatch adds to one pixel.

Path camera_path(ivec2 place, inout Sampler rng) {
    return start_path(camera_ray(frame.camera, vec2(frame.size), vec2(place), rng));
}

// One loop over the segments of all paths: a lane whose path has ended starts its next sample at
// once, and does not wait for its neighbours. `place`: pixel in the full frame. Returns how many
// samples are lost because the driver ended a loop early: this one, or one that a ray ran.
int add_samples(inout Pixel pixel, inout Layers layers, ivec2 place) {
    int index = frame.first_sample;
    int end = index + frame.sample_count;
    Sampler rng = sampler_at(place, index, frame.seed);
    Path path = camera_path(place, rng);
    while (index < end) {
        if (extend_path(path, rng)) continue;
        if (loop_was_cut) break;
        add_sample(pixel, path.radiance, index);
        if (LAYERS > 0) add_layers(layers, path, index);
        index += 1;
        rng = sampler_at(place, index, frame.seed);
        path = camera_path(place, rng);
    }
    drop_samples(pixel, index, end);
    return end - index;
}

int add_samples(inout Pixel pixel, ivec2 place) {
    Layers none = empty_layers();
    return add_samples(pixel, none, place);
}
