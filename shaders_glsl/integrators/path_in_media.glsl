// A path in a medium: it gathers emission on its way, and direct light where it collides.

// Adds the light that a medium emits on the segment: the mean over all collisions, so that it has no noise of its own.
void gather_glow(inout Path path, Medium medium, float distance) {
    if (medium.emission == vec3(0.0)) return;
    vec3 weight = path.scale * path.throughput * weight_of_flight(path.flight);
    vec3 light = weight * medium.emission * integral_of_decay(medium.extinction, distance);
    gather(path, light, medium.layer, path.depth);
}

// Flies over a segment of this length. True if the path collides there: then its ray starts at the collision. A
// medium that only absorbs takes its share without chance.
bool collides(inout Path path, float distance) {
    if (path.flight.medium == NO_MEDIUM) return false;
    Medium medium = medium_at(path.flight.medium);
    gather_glow(path, medium, distance);
    if (medium.scattering == vec3(0.0)) {
        path.throughput *= share_left(medium.extinction, distance);
        return false;
    }
    float extinction = medium.extinction[path.flight.channel];
    float depth = extinction * distance;
    bool is_met = path.flight.depth < depth;
    float way = is_met ? path.flight.depth / extinction : distance;
    path.flight.left *= share_left(medium.extinction, way);
    path.flight.depth -= depth;
    if (is_met) {
        path.throughput *= weight_of_collision(path.flight, medium);
        path.flight.left = vec3(1.0);
        path.ray.origin += way * path.ray.direction;
        path.ray.origin_shape = NO_SHAPE;
    }
    return is_met;
}

// Ends the flight where it meets a surface or leaves the scene.
void land(inout Path path) {
    path.throughput *= weight_of_flight(path.flight);
    path.flight.left = vec3(1.0);
}

// Adds light of a sample, scattered by a medium where the path collides.
void gather_in_medium(inout Path path, Medium medium, LightSample light) {
    if (light.pdf == 0.0 || is_dark(light)) return;
    float phase = eval_phase(medium.anisotropy, path.ray.direction, light.ray.direction);
    float weight = phase / light.pdf;
    if (WEIGHT_BOTH) weight *= power_heuristic(light.pdf, phase);
    vec3 left = light_left(light.ray, light.distance, light.shape, path.flight.medium);
    vec3 direct = path.scale * path.throughput * left * weight * light.radiance;
    gather(path, direct, light.layer, path.depth + 1);
}

// Gathers direct light where the path collides, then scatters it; false when the path ends.
bool scatter_in_medium(inout Path path, inout Sampler rng) {
    if (path.throughput == vec3(0.0)) {
        record_end(END_ABSORBED);
        return false;
    }
    if (path.depth == frame.bounces) {
        record_end(END_BOUNCE_LIMIT);
        return false;
    }
    leave_vertex(rng.seed, path.depth + 1);
    Medium medium = medium_at(path.flight.medium);
    path.lamps = total_weight(path.ray);
    if (SAMPLE_LIGHTS) gather_in_medium(path, medium, sample_light(path.ray, path.lamps, rng));
    if (SAMPLE_SKY) gather_in_medium(path, medium, sample_sky(path.ray, rng));
    if (SAMPLE_SUN) gather_in_medium(path, medium, sample_sun(path.ray, rng));
    vec3 from = path.ray.direction;
    path.ray.direction = sample_phase(medium.anisotropy, from, next_2d(rng));
    if (ROULETTE && roulette_ends(path.throughput, rng)) {
        record_end(END_BY_ROULETTE);
        return false;
    }
    path.pdf = eval_phase(medium.anisotropy, from, path.ray.direction);
    path.passed = Passed(0u, path.ray, 0.0);
    path.depth += 1;
    begin_flight(path.flight, path.throughput, rng);
    return true;
}
