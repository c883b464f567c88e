// One path from the camera: radiance in linear sRGB.
//
// Scattering that meets a lamp and sampling of lamps find the same light; METHOD says how they share
// it. naive: scattering alone. nee: sampling, where its density is not 0. mis: both, weighted by the
// power heuristic (Veach 1997, eq. 9.14). The other methods end where light is not followed
// (integrators/classic.glsl, integrators/effects.glsl).

// The share of emission that scattering may count. `pdf`: density of the scattered ray; 0 if the ray
// comes from the camera or a delta.
float emission_weight(Ray ray, Hit hit, int light, float pdf, float lamps) {
    if (!SAMPLE_LIGHTS || light == NO_LIGHT || pdf == 0.0) return 1.0;
    if (!is_sampled(light, ray)) return 1.0;
    float light_pdf = pdf_light(light, ray, hit.distance, lamps);
    float weight = WEIGHT_BOTH ? power_heuristic(pdf, light_pdf) : 0.0;
    record_weight(light_pdf, weight);
    return weight;
}

// The end of a path in the classic models: adds the light of the lamps and of a sky that nothing hides.
void shade(inout Path path, Vertex vertex, Ray from, inout Sampler rng) {
    vec3 weight = path.scale * path.throughput;
    if (OWN_PHONG && frame.phong_ambient >= 0.0) {
        if (LIGHT_TERMS != 0) sort_ambient(path);
        vec3 ambient = weight * head_on_reflectance(vertex.material) * frame.phong_ambient;
        gather(path, ambient, BACKGROUND_LAYER, path.depth + 1);
    } else if (HAS_BACKGROUND) {
        vec3 sky = unhidden_sky(vertex.frame[2]);
        if (LIGHT_TERMS != 0) sort_by_surface(path, vertex, vertex.frame[2], 1.0, false);
        gather(path, weight * head_on_reflectance(vertex.material) * sky, BACKGROUND_LAYER, path.depth + 1);
    }
    if (LAMP_KINDS == 0) return;
    if (MODEL == COOK) {
        LightSample light = sample_light(from, total_weight(from), rng);
        vec3 direct = weight * direct_light(vertex, light, 0.0, false);
        if (LIGHT_TERMS != 0) sort_by_surface(path, vertex, light.ray.direction, light.pdf, false);
        gather(path, direct, light.layer, path.depth + 1);
        return;
    }
    int i = 0;
    for (; i < light_count(); ++i) {
        int shape = light_at(i).shape;
        vec3 direct = weight * point_light(vertex, from, shape);
        vec3 away = normalized(point_lamp(shape).center - from.origin);
        if (LIGHT_TERMS != 0) sort_point_light(path, vertex, away);
        gather(path, direct, material_at(point_lamp(shape).material).layer, path.depth + 1);
    }
    note_end(i, light_count());
}

// The segment goes on through a surface: through a hole, or because its glass gives way to other glass.
void pass_hole(inout Path path, Surface surface, float distance) {
    int object = object_number(surface.shape);
    record_passing(is_displaced(path.counts, object) ? EVENT_PASSED_GLASS : EVENT_PASSED_HOLE);
    path.passed.holes += 1u;
    path.passed.way += distance;
    path.ray = beyond(path.ray, surface);
    if (HAS_MEDIA || HAS_RANKS) cross_bounds(path.flight.medium, path.counts, object, path.ray.inward);
}

// Whether a path was scattered by a medium on a segment along which lamps were sampled, this lamp among them.
bool is_from_medium(Path path, int light, Ray start) {
    return path.pdf > 0.0 && light != NO_LIGHT && path.approach.density > 0.0 && is_sampled(light, start);
}

// `emission_weight` for such a path.
float emission_beside_approach(Path path, Ray start, Hit hit, int light) {
    float light_pdf = pdf_light(light, start, hit.distance, path.lamps);
    float rival = rivalry(path.approach, light, choice_pdf(light, start, path.lamps));
    float other = light_pdf * sqrt(1.0 + rival * rival);
    float weight = WEIGHT_BOTH ? power_heuristic(path.pdf, other) : 0.0;
    record_weight(light_pdf, weight);
    return weight;
}

// `emission_weight` of the emission that a segment meets. The segment may have passed holes.
float weight_of_emission(Path path, Hit hit, Surface surface) {
    int light = surface.light;
    if (sees_lights(path) && light != NO_LIGHT) return weight_of_seen_lamp(path, surface);
    if (HAS_PARTICLES && path.rivals.rho > 0.0 && light != NO_LIGHT) {
        float kappa = 0.0;
        if (path.pdf > 0.0) kappa = pdf_light(light, path.ray, hit.distance, path.lamps) / path.pdf;
        float weight = emission_beside_particles(path.ray, hit, light, kappa, path.rivals.rho);
        record_weight(kappa * path.pdf, weight);
        return weight;
    }
    Ray start = path.ray;
    if (MAY_PASS) {
        hit.distance += path.passed.way;
        start = path.passed.start;
    }
    if (HAS_EQUIANGULAR && is_from_medium(path, light, start)) return emission_beside_approach(path, start, hit, light);
    return emission_weight(start, hit, light, path.pdf, path.lamps);
}

// Adds light of a sample, scattered where the path meets a surface. `source`: the object that shines, or
// FROM_BACKGROUND or FROM_SUN.
void gather_sampled(inout Path path, Meeting at, LightSample light, int source) {
    float height = dot(light.ray.direction, at.normals.facing);
    float along = dot(light.ray.direction, at.vertex.frame[2]);
    if (HAS_SHADING && height * along <= 0.0) light.pdf = 0.0;
    float rho = path.rivals.rho * path_turn(path, at, light.ray.direction, light.pdf, links_at(path, at.vertex));
    vec3 direct = path.scale * path.throughput * direct_light(at.vertex, light, rho, source == FROM_BACKGROUND);
    if (HAS_ATTENUATION) direct *= share_left(along < 0.0 ? at.behind : path.absorption, light.distance);
    if (HAS_MEDIA && direct != vec3(0.0)) {
        light.ray.inward = light.ray.inward != (along < 0.0);
        int medium = along < 0.0 ? at.medium : path.flight.medium;
        uint volumes = along < 0.0 ? at.beyond : path.counts;
        direct *= light_left(light.ray, light.distance, light.shape, medium, volumes);
    }
    record_sample(light.ray.direction, light.distance);
    record_light(BY_SAMPLING, source, light.pdf, light.radiance, direct);
    if (LIGHT_TERMS != 0) sort_by_surface(path, at.vertex, light.ray.direction, light.pdf, along < 0.0);
    gather(path, direct, light.layer, path.depth + 1);
}

// The share of the sky's light that scattering may count.
float sky_weight(Path path) {
    if (SKY_SENDS && sees_lights(path)) return weight_of_seen_afar(path, SKY_LIGHT);
    if (SKY_SENDS && path.rivals.rho > 0.0) {
        float kappa = SAMPLE_SKY && path.pdf > 0.0 ? pdf_sky(path.ray.direction) / path.pdf : 0.0;
        float share = emission_beside_particles(path.ray, Hit(0.0, NO_SHAPE), SKY_LIGHT, kappa, path.rivals.rho);
        record_weight(kappa * path.pdf, share);
        return share;
    }
    if (!SAMPLE_SKY || path.pdf == 0.0) return 1.0;
    float light_pdf = pdf_sky(path.ray.direction);
    if (light_pdf == 0.0) return 1.0;
    float weight = WEIGHT_BOTH ? power_heuristic(path.pdf, light_pdf) : 0.0;
    record_weight(light_pdf, weight);
    return weight;
}

// Adds the light of the sky where a path leaves the scene.
void gather_sky(inout Path path) {
    if (!HAS_BACKGROUND) return;
    if (CHOSEN && path.asking.is_open) return;
    vec3 radiance = background(path.ray.direction);
    vec3 light = path.scale * path.throughput * radiance;
    if (HAS_ATTENUATION) light *= share_left_of_sky(path.absorption);
    if (SAMPLE_SKY || SKY_SENDS) light *= sky_weight(path);
    record_light(BY_SCATTERING, FROM_BACKGROUND, path.pdf, radiance, light);
    gather(path, light, BACKGROUND_LAYER, path.depth);
}

// Adds the light of the sun where a path leaves the scene towards it.
void gather_sun(inout Path path) {
    if (!HAS_SUN || !meets_sun(path.ray.direction)) return;
    vec3 light = path.scale * path.throughput * frame.sun_radiance;
    if (HAS_ATTENUATION) light *= share_left_of_sky(path.absorption);
    if (sees_lights(path)) {
        light *= weight_of_seen_afar(path, SUN_LIGHT);
    } else if (HAS_PARTICLES && path.rivals.rho > 0.0) {
        float kappa = path.pdf > 0.0 ? pdf_sun() / path.pdf : 0.0;
        float weight = emission_beside_particles(path.ray, Hit(0.0, NO_SHAPE), SUN_LIGHT, kappa, path.rivals.rho);
        record_weight(kappa * path.pdf, weight);
        light *= weight;
    } else if (SAMPLE_SUN && path.pdf > 0.0) {
        float weight = WEIGHT_BOTH ? power_heuristic(path.pdf, pdf_sun()) : 0.0;
        record_weight(pdf_sun(), weight);
        light *= weight;
    }
    record_light(BY_SCATTERING, FROM_SUN, path.pdf, frame.sun_radiance, light);
    gather(path, light, SUN_LAYER, path.depth);
}

// Adds direct light where the path meets a surface, by one sample of each kind of light. `resamples`: lamps are
// candidates of a reservoir.
void gather_direct(inout Path path, Meeting at, bool resamples, inout Sampler rng) {
    if (is_delta(at.vertex.material)) return;
    if (SAMPLE_LIGHTS) {
        LightSample light = sample_light(at.ray, path.lamps, rng);
        if (RESAMPLES_LAMPS && resamples) offer_lamp(light, at.normals.facing);
        else gather_sampled(path, at, light, object_number(light.shape));
    }
    if (SAMPLE_SKY) {
        LightSample light = sample_sky(at.ray, rng);
        gather_sampled(path, at, light, FROM_BACKGROUND);
    }
    if (SAMPLE_SUN) {
        LightSample light = sample_sun(at.ray, rng);
        gather_sampled(path, at, light, FROM_SUN);
    }
}

// Adds the emission of the surface that the path meets.
void gather_emission(inout Path path, Surface surface, Material material, float share) {
    vec3 emission = emitted(material, -path.ray.direction, dot(path.ray.direction, true_normal(surface)) < 0.0);
    if (is_candidate(emission)) {
        offer_met(path, surface, emission, share);
        return;
    }
    vec3 light = path.scale * path.throughput * emission * share;
    record_light(BY_SCATTERING, object_number(surface.shape), path.pdf, emission, light);
    gather(path, light, material.layer, path.depth);
}

// Whether the path ends here. Else, if only direct light of this surface is still sought, the next segment is the last.
// Probes may have said so before; where they cannot be asked, the path goes on.
bool is_last_vertex(inout Path path, Material material) {
    if (!ends_paths(material)) return false;
    if (!HAS_PROBES || material.kind != MATTE) path.asking.is_done = true;
    bool is_sought = has_effect(SHADOWS) || has_effect(AMBIENT_OCCLUSION);
    return path.asking.is_done && (!is_sought || is_delta(material));
}

// Gathers direct light at a surface, then scatters the path there; false when the path ends.
bool scatter_path(inout Path path, Surface surface, Material whole, inout Sampler rng) {
    leave_vertex(rng.seed, path.depth + 1);
    Material material = part_met(whole, rng);
    Meeting at = meet(path, surface, material, true);
    if (!is_followed(material)) {
        shade(path, at.vertex, at.ray, rng);
        return false;
    }
    path.lamps = total_weight(at.ray);
    path.rivals.rho = rho_beyond(path, at);
    bool resamples = begins_resampling(path, material);
    if (resamples) begin_resampling(path, at.vertex, at.ray);
    gather_direct(path, at, resamples, rng);
    gather_open_sky(path, at.vertex);
    gather_from_probes(path, at.vertex, surface.position, rng);
    if (is_last_vertex(path, material)) {
        record_end(END_ABSORBED);
        return false;
    }
    Scattering next;
    if (MODEL == WHITTED_TREE && is_split(material)) next = split_path(path, at);
    else next = sample_material(at.vertex, rng);
    record_scattering(at.vertex.frame[2], next.direction, next.pdf, next.crosses);
    if (LIGHT_TERMS != 0) sort_by_surface(path, at.vertex, next.direction, next.pdf, next.crosses);
    if (is_left_out(material, next.crosses)) {
        record_end(END_ABSORBED);
        return false;
    }
    if (is_lost(at, next)) {
        record_end(END_BELOW_SURFACE);
        return false;
    }
    path.rivals.rho *= path_turn(path, at, next.direction, next.pdf, links_at(path, at.vertex));
    follow_chain(path.rivals.chain, surface.shape, at.vertex, next.crosses);
    path.throughput *= next.weight;
    if (path.throughput == vec3(0.0)) {
        record_end(END_ABSORBED);
        return false;
    }
    if (HAS_DIELECTRIC) path.scale *= next.scale;
    if (ROULETTE && !resamples && roulette_ends(path.throughput, rng)) {
        record_end(END_BY_ROULETTE);
        return false;
    }
    leave(path, at, next);
    path.passed = Passed(0u, path.ray, 0.0);
    path.pdf = next.pdf;
    if (HAS_MEDIA) begin_flight(path.flight, path.throughput, rng);
    if (HAS_EQUIANGULAR) path.approach = no_approach();
    return true;
}

// Follows one segment; false when the path ends with it.
bool extend_path(inout Path path, inout Sampler rng) {
    if (path.passed.holes == 0u) leave_vertex(rng.seed, path.depth);
    Hit hit = next_hit(path.ray, path.depth);
    if (HAS_MEDIA && collides(path, hit.distance)) return scatter_in_medium(path, rng);
    if (hit.shape == NO_SHAPE) {
        if (HAS_MEDIA) land(path);
        gather_sky(path);
        gather_sun(path);
        record_end(END_LEFT_SCENE);
        return false;
    }
    Surface surface = surface_at(path.ray, hit);
    Material material = material_of(path.ray, surface);
    float share = weight_of_emission(path, hit, surface);
    bool enters = dot(path.ray.direction, true_normal(surface)) < 0.0;
    absorb(path, material, !enters, hit.distance);
    vec3 arriving = path.scale * path.throughput;
    if (HAS_MEDIA) arriving *= weight_of_flight(path.flight);
    record_vertex(surface.position, true_normal(surface), surface.normal, object_number(surface.shape), hit.distance,
                  arriving);
    if (HAS_NESTED && is_within_other_glass(path, material, enters)) {
        pass_glass(path, surface, material, enters);
        return true;
    }
    if (MAY_PASS && is_passed(material, path.passed.holes, path.counts, object_number(surface.shape))) {
        pass_hole(path, surface, hit.distance);
        return true;
    }
    if (HAS_MEDIA) land(path);
    if (!CHOSEN || !path.asking.is_done || has_effect(SHADOWS)) gather_emission(path, surface, material, share);
    meet_second(path, surface, material);
    if (path.depth == frame.bounces || (HAS_PROBES || CHOSEN) && path.asking.is_done) {
        record_end(END_BOUNCE_LIMIT);
        return false;
    }
    return scatter_path(path, surface, material, rng);
}
