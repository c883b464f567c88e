// One path from the camera: radiance in linear sRGB.
//
// Emission found by scattering and emission sampled on lamps are the same light; METHOD says how
// they share it. naive: scattering alone. nee: sampling, where its density is not 0. mis: both,
// weighted by the power heuristic (Veach 1997, eq. 9.14). The other methods end where light is not
// followed (integrators/classic.glsl).

// Of light sampled on a lamp; `scattered`: the density with which scattering would have met it.
float weight_of_sample(LightSample light, float scattered, float rho) {
    if (HAS_PARTICLES && rho > 0.0) return sample_beside_particles(light, scattered, rho);
    return power_heuristic(light.pdf, scattered);
}

// The share of emission that scattering may count. `pdf`: density of the scattered ray; 0 if it
// comes from the camera or a delta.
float emission_weight(Ray ray, Hit hit, int light, float pdf, float lamps) {
    if (!SAMPLE_LIGHTS || light == NO_LIGHT || pdf == 0.0) return 1.0;
    if (!is_sampled(light, ray)) return 1.0;
    precise float light_pdf = pdf_light(light, ray, hit.distance, lamps);
    precise float weight = WEIGHT_BOTH ? power_heuristic(pdf, light_pdf) : 0.0;
    record_weight(light_pdf, weight);
    return weight;
}

// Direct light from one sampled point, scattered towards wo; `rho` as Path has it.
vec3 direct_light(Vertex vertex, LightSample light, float rho) {
    if (light.pdf == 0.0 || is_dark(light)) return vec3(0.0);
    precise vec3 wi = to_local(vertex.frame, light.ray.direction);
    bool crosses = is_rough_glass(vertex.material) && wi.z < 0.0;
    if (wi.z <= 0.0 && !crosses) return vec3(0.0);
    if (crosses) light.ray.inward = !light.ray.inward;
    precise vec3 weight = eval_material(vertex, wi) / light.pdf;
    if (WEIGHT_BOTH) {
        precise float scattered = pdf_material(vertex, wi);
        precise float share = weight_of_sample(light, scattered, rho);
        record_weight(scattered, share);
        weight *= share;
    }
    if (occluded(light.ray, light.distance, light.shape)) {
        record_shadow();
        return vec3(0.0);
    }
    precise vec3 radiance = weight * light.radiance;
    return radiance;
}

// Of paths from the camera: to end those below 1/4 saves more time than it adds variance (docs/results/speed.md).
bool roulette_ends(precise inout vec3 throughput, precise inout Sampler rng) {
    return ends_at_random(throughput, 4.0, rng);
}

// Where a model of the classic models ends: the light of the lamps and of an unhidden sky.
void shade(precise inout Path path, Vertex vertex, Ray from, precise inout Sampler rng) {
    precise vec3 weight = path.scale * path.throughput;
    if (HAS_BACKGROUND) {
        precise vec3 sky = unhidden_sky(vertex.frame[2]);
        gather(path, weight * head_on_reflectance(vertex.material) * sky, BACKGROUND_LAYER, path.depth + 1);
    }
    if (LAMP_KINDS == 0) return;
    if (MODEL == COOK) {
        precise LightSample light = sample_light(from, total_weight(from), rng);
        precise vec3 direct = weight * direct_light(vertex, light, 0.0);
        gather(path, direct, light.layer, path.depth + 1);
        return;
    }
    int i = 0;
    for (; i < light_count(); ++i) {
        int shape = light_at(i).shape;
        precise vec3 direct = weight * point_light(vertex, from, shape);
        gather(path, direct, material_at(point_lamp(shape).material).layer, path.depth + 1);
    }
    note_end(i, light_count());
}

// Of what lies behind a surface of this material; `enters`: whether behind is its inside.
vec3 absorption_behind(Path path, Material material, bool enters) {
    if (is_medium(material)) {
        uint counts = counts_beyond(path.counts, material.details, enters);
        return absorption_of_glass(medium_of(counts));
    }
    if (material.kind != DIELECTRIC) return path.absorption;
    return enters ? absorption_of_glass(material.details) : vec3(0.0);
}

// What a segment that ends at this surface loses. That of glass met from inside lay in it.
void absorb(precise inout Path path, Material material, bool inside, float distance) {
    bool is_glass = material.kind == DIELECTRIC && !is_medium(material);
    if (is_glass && inside) path.absorption = absorption_of_glass(material.details);
    path.throughput *= share_left(path.absorption, distance);
}

// Whether a surface of glass lies in another glass that stays: nothing happens there, and no light that
// was sampled has passed it.
bool passes(precise inout Path path, Surface surface, Material material, bool enters) {
    if (!is_medium(material)) return false;
    uint beyond = counts_beyond(path.counts, material.details, enters);
    if (medium_of(beyond) != medium_of(path.counts)) return false;
    record_passing(EVENT_PASSED_GLASS);
    path.counts = beyond;
    path.ray = Ray(surface.position, path.ray.direction, surface.shape, enters);
    path.pdf = 0.0;
    return true;
}

// Whether a segment goes on through a hole of a surface.
bool passes_hole(precise inout Path path, Surface surface, Material material, float distance) {
    if (!is_hole(material, path.holes)) return false;
    record_passing(EVENT_PASSED_HOLE);
    path.holes += 1u;
    path.way += distance;
    path.ray = beyond(path.ray, surface);
    return true;
}

// `emission_weight` of what a segment meets, which may have passed holes.
float weight_of_emission(Path path, Hit hit, int light) {
    if (HAS_PARTICLES && path.rho > 0.0 && light != NO_LIGHT) {
        precise float kappa = 0.0;
        if (path.pdf > 0.0) kappa = pdf_light(light, path.ray, hit.distance, path.lamps) / path.pdf;
        precise float weight = emission_beside_particles(path.ray, hit, light, kappa, path.rho);
        record_weight(kappa * path.pdf, weight);
        return weight;
    }
    if (!HAS_HOLE) return emission_weight(path.ray, hit, light, path.pdf, path.lamps);
    precise Hit met = Hit(path.way + hit.distance, hit.shape);
    return emission_weight(path.start, met, light, path.pdf, path.lamps);
}

// Light of a sample, scattered at a vertex. `behind`: what the other side absorbs; `source`: the object that shines, or
// FROM_BACKGROUND or FROM_SUN; `normals` and `is_linked` as in path_turn.
void gather_sampled(precise inout Path path, Vertex vertex, LightSample light, int source, Normals normals, vec3 behind,
                    bool is_linked) {
    precise float height = dot(light.ray.direction, normals.facing);
    precise float along = dot(light.ray.direction, vertex.frame[2]);
    if (HAS_SHADING && height * along <= 0.0) light.pdf = 0.0;
    precise float rho = path.rho;
    if (HAS_PARTICLES) rho *= path_turn(path, vertex, normals, light.ray.direction, is_linked);
    precise vec3 direct = path.scale * path.throughput * direct_light(vertex, light, rho);
    if (HAS_ATTENUATION) direct *= share_left(along < 0.0 ? behind : path.absorption, light.distance);
    record_sample(light.ray.direction, light.distance);
    record_light(BY_SAMPLING, source, light.pdf, light.radiance, direct);
    gather(path, direct, light.layer, path.depth + 1);
}

// The share of the sky's light that scattering may count.
float sky_weight(Path path) {
    if (SKY_SENDS && path.rho > 0.0) {
        precise float kappa = SAMPLE_SKY && path.pdf > 0.0 ? pdf_sky(path.ray.direction) / path.pdf : 0.0;
        precise float share = emission_beside_particles(path.ray, Hit(0.0, NO_SHAPE), SKY_LIGHT, kappa, path.rho);
        record_weight(kappa * path.pdf, share);
        return share;
    }
    if (!SAMPLE_SKY || path.pdf == 0.0) return 1.0;
    precise float light_pdf = pdf_sky(path.ray.direction);
    if (light_pdf == 0.0) return 1.0;
    precise float weight = WEIGHT_BOTH ? power_heuristic(path.pdf, light_pdf) : 0.0;
    record_weight(light_pdf, weight);
    return weight;
}

// The sun, where a path that meets nothing meets it.
void gather_sun(precise inout Path path) {
    if (!meets_sun(path.ray.direction)) return;
    precise vec3 light = path.scale * path.throughput * frame.sun_radiance;
    if (HAS_ATTENUATION) light *= share_left_of_sky(path.absorption);
    if (HAS_PARTICLES && path.rho > 0.0) {
        precise float kappa = path.pdf > 0.0 ? pdf_sun() / path.pdf : 0.0;
        precise float weight = emission_beside_particles(path.ray, Hit(0.0, NO_SHAPE), SUN_LIGHT, kappa, path.rho);
        record_weight(kappa * path.pdf, weight);
        light *= weight;
    } else if (SAMPLE_SUN && path.pdf > 0.0) {
        precise float weight = WEIGHT_BOTH ? power_heuristic(path.pdf, pdf_sun()) : 0.0;
        record_weight(pdf_sun(), weight);
        light *= weight;
    }
    record_light(BY_SCATTERING, FROM_SUN, path.pdf, frame.sun_radiance, light);
    gather(path, light, SUN_LAYER, path.depth);
}

// Direct light at a vertex, of a sample of each kind. `ray` leaves there, where all lamps have the weight `lamps`;
// `normals` and `behind` as above; `resamples`: lamps are candidates of a reservoir.
void gather_direct(precise inout Path path, Vertex vertex, Ray ray, float lamps, Normals normals, vec3 behind,
                   bool resamples, precise inout Sampler rng) {
    bool is_linked = links_at(path, vertex);
    if (SAMPLE_LIGHTS) {
        precise LightSample light = sample_light(ray, lamps, rng);
        if (RESAMPLES_LAMPS && resamples) offer_lamp(light, normals.facing);
        else gather_sampled(path, vertex, light, object_number(light.shape), normals, behind, is_linked);
    }
    if (SAMPLE_SKY) {
        precise LightSample light = sample_sky(ray, rng);
        gather_sampled(path, vertex, light, FROM_BACKGROUND, normals, behind, is_linked);
    }
    if (SAMPLE_SUN) {
        precise LightSample light = sample_sun(ray, rng);
        gather_sampled(path, vertex, light, FROM_SUN, normals, behind, is_linked);
    }
}

// Scatters at a surface, after gathering direct light there; false when the path ends.
bool scatter_path(precise inout Path path, Surface surface, Material material, precise inout Sampler rng) {
    leave_vertex(rng.seed, path.depth + 1);
    if (HAS_TRANSMISSION && material.kind == PRINCIPLED) material = met_part(material, next_1d(rng));
    precise vec3 facing = true_normal(surface);
    precise float side = dot(path.ray.direction, facing) < 0.0 ? 1.0 : -1.0;  // 1: outer
    facing *= side;
    precise vec3 shaded = HAS_NORMAL_MAP ? bent_normal(path.ray, surface) : surface.normal;
    precise Normals normals = Normals(facing, side * shaded);
    precise mat3 around = shading_frame(facing, normals.shading, path.ray.direction);
    precise Vertex vertex = vertex_of(around, to_local(around, -path.ray.direction), material, side > 0.0);
    precise Ray ray = Ray(surface.position, path.ray.direction, surface.shape, side < 0.0);
    if (!is_followed(material)) {
        shade(path, vertex, ray, rng);
        return false;
    }
    uint beyond = path.counts;
    if (is_medium(material)) {
        beyond = counts_beyond(path.counts, material.details, side > 0.0);
        vertex.eta = ior_of_medium(path.counts) / ior_of_medium(beyond);
    }
    precise vec3 behind = HAS_ATTENUATION ? absorption_behind(path, material, side > 0.0) : vec3(0.0);
    precise float lamps = total_weight(ray);
    if (HAS_PARTICLES) path.rho = rho_beyond(path, vertex, surface, facing);
    bool resamples = begins_resampling(path, material);
    if (resamples) begin_resampling(path, vertex, ray);
    if (!is_delta(material)) gather_direct(path, vertex, ray, lamps, normals, behind, resamples, rng);
    if (HAS_PROBES) gather_from_probes(path, vertex, surface.position, rng);
    precise Scattering next = sample_material(vertex, rng);
    record_scattering(vertex.frame[2], next.direction, next.pdf, next.crosses);
    bool is_linked = links_at(path, vertex);
    if (LINKED != 0) follow_chain(path.chain, surface.shape, vertex, next.crosses);
    if (HAS_SHADING && (dot(next.direction, facing) < 0.0) != next.crosses) return goes_on(END_BELOW_SURFACE);
    if (HAS_PARTICLES) path.rho *= path_turn(path, vertex, normals, next.direction, is_linked);
    path.throughput *= next.weight;
    if (path.throughput == vec3(0.0)) return goes_on(END_ABSORBED);
    if (HAS_DIELECTRIC) path.scale *= next.scale;
    if (ROULETTE && !resamples && roulette_ends(path.throughput, rng)) return goes_on(END_BY_ROULETTE);
    ray.direction = next.direction;
    ray.inward = (side < 0.0) != next.crosses;
    path.ray = ray;
    if (HAS_ATTENUATION && next.crosses) path.absorption = behind;
    if (HAS_NESTED && next.crosses) path.counts = beyond;
    path.holes = 0u;
    path.start = ray;
    path.way = 0.0;
    path.pdf = next.pdf;
    path.lamps = lamps;
    path.depth += 1;
    return true;
}

// Follows one segment; false when the path ends with it.
bool extend_path(precise inout Path path, precise inout Sampler rng) {
    if (path.holes == 0u) leave_vertex(rng.seed, path.depth);
    precise Hit hit = closest_hit(path.ray);
    if (hit.shape == NO_SHAPE) {
        if (HAS_BACKGROUND) {
            precise vec3 sky = path.scale * path.throughput * background(path.ray.direction);
            if (HAS_ATTENUATION) sky *= share_left_of_sky(path.absorption);
            if (SAMPLE_SKY || SKY_SENDS) sky *= sky_weight(path);
            record_light(BY_SCATTERING, FROM_BACKGROUND, path.pdf, background(path.ray.direction), sky);
            gather(path, sky, BACKGROUND_LAYER, path.depth);
        }
        if (HAS_SUN) gather_sun(path);
        return goes_on(END_LEFT_SCENE);
    }
    precise Surface surface = surface_at(path.ray, hit);
    precise Material material = material_of(path.ray, surface);
    precise float share = weight_of_emission(path, hit, surface.light);
    bool facing = dot(path.ray.direction, true_normal(surface)) < 0.0;
    if (HAS_ATTENUATION) absorb(path, material, !facing, hit.distance);
    record_vertex(surface.position, true_normal(surface), surface.normal, object_number(surface.shape), hit.distance,
                  path.scale * path.throughput);
    if (HAS_NESTED && passes(path, surface, material, facing)) return true;
    if (HAS_HOLE && passes_hole(path, surface, material, hit.distance)) return true;
    precise vec3 emission = emitted(material, -path.ray.direction, facing);
    if (!offers_met(path, surface, emission, share)) {
        precise vec3 light = path.scale * path.throughput * emission * share;
        record_light(BY_SCATTERING, object_number(surface.shape), path.pdf, emission, light);
        gather(path, light, material.layer, path.depth);
    }
    if (RESAMPLES) meet_second(path, surface, material);
    if (path.depth == frame.bounces || HAS_PROBES && path.is_last) return goes_on(END_BOUNCE_LIMIT);
    return scatter_path(path, surface, material, rng);
}
