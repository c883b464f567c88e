// A path in a medium: it gathers emission on its way, and direct light where it collides.

// Adds the light that a medium emits on the segment: the mean over all collisions, so that it has no noise of its own.
void gather_glow(inout Path path, Medium medium, float distance) {
    if (medium.emission == vec3(0.0)) return;
    vec3 weight = path.scale * path.throughput * weight_of_flight(path.flight);
    vec3 light = weight * medium.emission * integral_of_decay(medium.extinction, distance);
    record_light(BY_SCATTERING, FROM_MEDIUM - path.flight.medium, path.pdf, medium.emission, light);
    gather(path, light, medium.layer, path.depth);
}

// Adds light of a lamp at a place on a segment that ends after this distance, on its first segment through a medium
// that scatters. It belongs to the vertex that a collision there would be. Returns the segment, with a density of 1.
Approach approach_lamps(inout Path path, Medium medium, float distance) {
    vec4 dice = path.flight.dice;
    path.flight.dice.x = -1.0;
    if (path.depth == frame.bounces) return no_approach();
    Approach at = Approach(path.ray.origin, path.ray.direction, distance, 0.0, 1.0, 0.0);
    for (int i = 0; i < CLUSTERS; ++i) at.total += nearness(sight_of(at, cluster_at(i)), cluster_at(i));
    float target = dice.x * at.total;
    float sum = 0.0;
    int lamp = 0;
    for (int i = 1; i < CLUSTERS; ++i) {
        sum += nearness(sight_of(at, cluster_at(i - 1)), cluster_at(i - 1));
        if (sum <= target) lamp = i;
    }
    Sight sight = sight_of(at, cluster_at(lamp));
    Approach found = at;
    at.way = sample_equiangular(sight, dice.y);
    float chance = dot(path.flight.chances, path.flight.left);
    if (!(at.way < distance) || chance == 0.0) return found;
    Flight flight = path.flight;
    flight.left *= share_left(medium.extinction, at.way);
    at.density = density_of_collision(flight, medium) / chance;
    Ray ray = Ray(at.origin + at.way * at.direction, at.direction, NO_SHAPE, false);
    LightSample light = sample_lamp(ray, lamp, dice.zw, total_weight(ray));
    float choice = choice_pdf(lamp, ray, total_weight(ray));
    if (light.pdf == 0.0 || choice == 0.0 || is_dark(light)) return found;
    float phase = eval_phase(medium.anisotropy, at.direction, light.ray.direction);
    float other = WEIGHT_BOTH ? phase / light.pdf : 0.0;
    float rival = 1.0 / rivalry(at, lamp, choice);
    float weight = 1.0 / (1.0 + rival * rival * (1.0 + other * other));
    float pdf = nearness(sight, cluster_at(lamp)) / at.total * pdf_equiangular(sight, at.way) * (light.pdf / choice);
    vec3 scattered = path.scale * path.throughput * flight.left / chance * medium.scattering;
    vec3 direct = scattered * (weight * phase / pdf) * light.radiance;
    if (direct == vec3(0.0)) return found;
    uint own = leave_for_a_ray();  // the segment may have passed holes by these numbers
    direct *= light_left(light.ray, light.distance, light.shape, path.flight.medium, path.counts);
    hole_key = own;
    if (LIGHT_TERMS != 0) sort_by_medium(path);
    record_weight(0.0, weight);
    record_light(BY_SAMPLING, object_number(light.shape), pdf, light.radiance, direct);
    gather(path, direct, light.layer, path.depth + 1);
    return found;
}

// Scatters the path where it collides, so far on its segment: its ray starts there.
void collide(inout Path path, Medium medium, float way) {
    path.throughput *= weight_of_collision(path.flight, medium);
    path.flight.left = vec3(1.0);
    path.ray.origin += way * path.ray.direction;
    path.ray.origin_shape = NO_SHAPE;
    vec3 along = path.ray.direction;
    int object = FROM_MEDIUM - path.flight.medium;
    record_vertex(path.ray.origin, along, along, object, way, path.scale * path.throughput);
}

// Flies over a segment of this length through a grid, like `collides`.
bool collides_in_grid(inout Path path, Medium medium, float distance) {
    if (medium.scattering == vec3(0.0)) {
        GridShare found = cross_grid(medium, path.ray, distance);
        vec3 light = path.scale * path.throughput * weight_of_flight(path.flight) * found.glow;
        if (medium.emission != vec3(0.0)) {
            record_light(BY_SCATTERING, FROM_MEDIUM - path.flight.medium, path.pdf, medium.emission, light);
            gather(path, light, medium.layer, path.depth);
        }
        path.throughput *= found.share;
        return false;
    }
    vec3 rates = fictitious(medium);
    March march = enter_grid(medium, path.ray, distance);
    while (march.way < march.end) {
        float top = top_of_brick(medium, march.brick);
        float rate = top * rates[path.flight.channel];
        float room = rate * (march.stop - march.way);
        bool is_met = path.flight.depth < room;
        float way = is_met ? path.flight.depth / rate : march.stop - march.way;
        path.flight.left *= share_left(top * rates, way);
        if (!is_met) {
            path.flight.depth -= room;
            leave_brick(march, medium);
            continue;
        }
        march.way += way;
        float density = density_at(medium, march.start + march.way * march.along);
        vec3 real = density * medium.extinction;
        if (medium.emission != vec3(0.0)) {
            vec3 weight = path.flight.left / dot(path.flight.chances, path.flight.left * rates * top);
            vec3 light = path.scale * path.throughput * weight * density * medium.emission;
            record_light(BY_SCATTERING, FROM_MEDIUM - path.flight.medium, path.pdf, medium.emission, light);
            gather(path, light, medium.layer, path.depth);
        }
        if (next_of_collision() * rate < real[path.flight.channel]) {
            if (HAS_EQUIANGULAR) path.approach = no_approach();
            collide(path, medium, march.way);
            return true;
        }
        path.flight.left *= max(top * rates - real, vec3(0.0));
        path.flight.left /= max(max(path.flight.left.x, path.flight.left.y), path.flight.left.z);
        path.flight.depth = depth_of(next_of_collision());
    }
    note_end(march.way < march.end ? 0 : 1, 1);
    return false;
}

// Flies over a segment of this length through a scientific volume.
void cross_volume(inout Path path, float distance) {
    GridShare found = cross_classified(path.flight.medium, path.ray, distance);
    vec3 light = path.scale * path.throughput * weight_of_flight(path.flight) * found.glow;
    record_light(BY_SCATTERING, FROM_MEDIUM - path.flight.medium, path.pdf, found.glow, light);
    gather(path, light, medium_at(path.flight.medium).layer, path.depth);
    path.throughput *= found.share;
}

// Flies over a segment of this length in steps, through a grid or a scientific volume, like `collides`.
bool collides_in_steps(inout Path path, float distance) {
    int row = path.flight.medium;
    Medium medium = medium_at(row);
    Steps steps = first_step(medium, path.ray, distance);
    while (is_in_grid(steps)) {
        Medium even = medium_of_step(row, medium, steps);
        float length = steps.end - steps.begin;
        gather_glow(path, even, length);
        float way = 0.0;
        if (medium.scattering == vec3(0.0)) {
            path.throughput *= share_left(even.extinction, length);
        } else if (flies_into(path.flight, even, length, way)) {
            if (HAS_EQUIANGULAR) path.approach = no_approach();
            collide(path, even, steps.begin + way);
            return true;
        }
        next_step(steps);
    }
    note_end(is_in_grid(steps) ? 0 : 1, 1);
    return false;
}

// Flies over a segment of this length. True if the path collides there: then its ray starts at the collision. A
// medium that only absorbs takes its share without chance.
bool collides(inout Path path, float distance) {
    if (path.flight.medium == NO_MEDIUM) return false;
    if (MARCHES && has_grid(medium_at(path.flight.medium))) return collides_in_steps(path, distance);
    if (HAS_TRANSFER && is_classified(path.flight.medium)) {
        cross_volume(path, distance);
        return false;
    }
    Medium medium = medium_at(path.flight.medium);
    if (HAS_GRID && has_grid(medium)) return collides_in_grid(path, medium, distance);
    gather_glow(path, medium, distance);
    if (medium.scattering == vec3(0.0)) {
        path.throughput *= share_left(medium.extinction, distance);
        return false;
    }
    Approach approach = no_approach();
    if (HAS_EQUIANGULAR && path.flight.dice.x >= 0.0) approach = approach_lamps(path, medium, distance);
    float chance = dot(path.flight.chances, path.flight.left);
    float way = 0.0;
    bool is_met = flies_into(path.flight, medium, distance, way);
    if (is_met) {
        if (HAS_EQUIANGULAR) {
            path.approach = approach;
            path.approach.way = way;
            if (approach.density > 0.0) path.approach.density = density_of_collision(path.flight, medium) / chance;
        }
        collide(path, medium, way);
    }
    return is_met;
}

// Ends the flight where it meets a surface or leaves the scene.
void land(inout Path path) {
    path.throughput *= weight_of_flight(path.flight);
    path.flight.left = vec3(1.0);
}

// Adds light of a sample, scattered by a medium where the path collides.
void gather_in_medium(inout Path path, Medium medium, LightSample light, int source) {
    if (light.pdf == 0.0 || is_dark(light)) return;
    float phase = eval_phase(medium.anisotropy, path.ray.direction, light.ray.direction);
    float weight = phase / light.pdf;
    float share = 1.0;
    if (HAS_EQUIANGULAR && light.light >= 0) {
        float rival = rivalry(path.approach, light.light, choice_pdf(light.light, path.ray, path.lamps));
        share = weight_beside_approach(light.pdf, WEIGHT_BOTH ? phase : 0.0, rival);
    } else if (WEIGHT_BOTH) {
        share = power_heuristic(light.pdf, phase);
    }
    weight *= share;
    vec3 left = light_left(light.ray, light.distance, light.shape, path.flight.medium, path.counts);
    vec3 direct = path.scale * path.throughput * left * weight * light.radiance;
    record_weight(WEIGHT_BOTH ? phase : 0.0, share);
    if (left == vec3(0.0)) record_shadow();
    record_sample(light.ray.direction, light.distance);
    record_light(BY_SAMPLING, source, light.pdf, light.radiance, direct);
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
    if (LIGHT_TERMS != 0) sort_by_medium(path);
    if (SAMPLE_LIGHTS) {
        LightSample light = sample_light(path.ray, path.lamps, rng);
        gather_in_medium(path, medium, light, object_number(light.shape));
    }
    if (SAMPLE_SKY) gather_in_medium(path, medium, sample_sky(path.ray, rng), FROM_BACKGROUND);
    if (SAMPLE_SUN) gather_in_medium(path, medium, sample_sun(path.ray, rng), FROM_SUN);
    vec3 from = path.ray.direction;
    path.ray.direction = sample_phase(medium.anisotropy, from, next_2d(rng));
    record_scattering(from, path.ray.direction, eval_phase(medium.anisotropy, from, path.ray.direction), false);
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
