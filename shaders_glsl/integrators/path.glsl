// One path from the camera: radiance in linear sRGB.
//
// Emission found by scattering and emission sampled on lamps are the same light; METHOD says how
// they share it. naive: scattering alone. nee: sampling, where its density is not 0. mis: both,
// weighted by the power heuristic (Veach 1997, eq. 9.14). The other methods end where light is not
// followed (integrators/classic.glsl).

// p_a^2 / (p_a^2 + p_b^2), written so that no square overflows to NaN; p_a is above 0.
float power_heuristic(float p_a, float p_b) {
    precise float ratio = p_b / p_a;
    precise float weight = 1.0 / (1.0 + ratio * ratio);
    return weight;
}

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
    return WEIGHT_BOTH ? power_heuristic(pdf, light_pdf) : 0.0;
}

// Direct light from one sampled point, scattered towards wo; `rho` as Path has it.
vec3 direct_light(Vertex vertex, LightSample light, float rho) {
    if (light.pdf == 0.0 || is_dark(light)) return vec3(0.0);
    precise vec3 wi = to_local(vertex.frame, light.ray.direction);
    bool crosses = is_rough_glass(vertex.material) && wi.z < 0.0;
    if (wi.z <= 0.0 && !crosses) return vec3(0.0);
    if (crosses) light.ray.inward = !light.ray.inward;
    precise vec3 weight = eval_material(vertex, wi) / light.pdf;
    if (WEIGHT_BOTH) weight *= weight_of_sample(light, pdf_material(vertex, wi), rho);
    if (occluded(light.ray, light.distance, light.shape)) return vec3(0.0);
    precise vec3 radiance = weight * light.radiance;
    return radiance;
}

// Divides the survivors' throughput by their chance: another variance, the same mean. It applies
// once the throughput is below 1 / keep. Chances are multiples of 2^-16, which random numbers of 20 bits, as Sobol's are,
// meet exactly.
const float CHANCES = 65536.0;

bool ends_at_random(precise inout vec3 throughput, float keep, precise inout Sampler rng) {
    precise float brightest = max(throughput.x, max(throughput.y, throughput.z));
    precise float survival = min(ceil(keep * CHANCES * brightest) / CHANCES, 1.0);
    if (next_1d(rng) >= survival) return true;
    throughput /= survival;
    return false;
}

// Of paths from the camera: to end those below 1/4 saves more time than it adds variance (docs/results/speed.md).
bool roulette_ends(precise inout vec3 throughput, precise inout Sampler rng) {
    return ends_at_random(throughput, 4.0, rng);
}

struct Path {
    Ray ray;          // its next segment
    vec3 throughput;
    float scale;      // of radiance by refraction, which roulette ignores
    vec3 radiance;    // gathered so far
    float pdf;        // of the last scattering; 0 if it was a delta, or none yet
    float lamps;      // weight of all that are sampled, where it scattered last
    int depth;        // scattering events so far
    vec3 absorption;  // of the glass that its next segment lies in
    uint counts;      // of the glasses with a priority there
    uint holes;       // that this segment has passed
    Ray start;        // it, where it left the vertex, if it has
    float way;        // from there to the last hole
    float rho;        // what particles are weighed against (integrators/particle_weights.glsl); 0: they do not come
    Chain chain;      // of what it met first
    vec3 layers[MOST_LAYERS];  // the radiance by layers
};

Path start_path(Ray ray) {
    precise vec3 absorption = HAS_ATTENUATION ? frame.camera_absorption : vec3(0.0);
    uint counts = HAS_NESTED ? frame.camera_counts : 0u;
    return Path(ray, vec3(1.0), 1.0, vec3(0.0), 0.0, 0.0, 0, absorption, counts, 0u, ray, 0.0, 0.0, start_chain(ray),
                NO_LAYERS);
}

// Light of a lamp that is `length` scattering events from the camera; `group` is its layer.
void gather(precise inout Path path, vec3 light, int group, int length) {
    path.radiance += light;
    if (LAYERS > 0) add_to_layer(path.layers, light, BY_LENGTH ? length : group);
}

// Where a model of the classic models ends: the light of the lamps and of an unhidden sky.
void shade(precise inout Path path, Vertex vertex, Ray from, precise inout Sampler rng) {
    precise vec3 weight = path.scale * path.throughput;
    if (HAS_BACKGROUND) {
        precise vec3 sky = unhidden_sky(vertex.frame[2]);
        gather(path, weight * head_on_reflectance(vertex.material) * sky, BACKGROUND_LAYER, path.depth + 1);
    }
    if (!(HAS_SPHERE_LIGHT || HAS_QUAD_LIGHT || HAS_DISK_LIGHT || HAS_MESH_LIGHT)) return;
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

// Around the shading normal, on the side of wo; around the facet's own where the shading normal faces
// away from wo, or would reflect it through the surface.
mat3 shading_frame(vec3 facing, vec3 normal, vec3 direction) {
    if (HAS_SMOOTH || HAS_NORMAL_MAP) {
        precise float along = dot(normal, direction);
        precise vec3 reflected = direction - 2.0 * along * normal;
        if (along >= 0.0 || dot(reflected, facing) <= 0.0) return frame_around(facing);
    }
    return frame_around(normal);
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
    path.counts = beyond;
    path.ray = Ray(surface.position, path.ray.direction, surface.shape, enters);
    path.pdf = 0.0;
    return true;
}

// Whether a segment goes on through a hole of a surface.
bool passes_hole(precise inout Path path, Surface surface, Material material, float distance) {
    if (!is_hole(material, path.holes)) return false;
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
        return emission_beside_particles(path.ray, hit, light, kappa, path.rho);
    }
    if (!HAS_HOLE) return emission_weight(path.ray, hit, light, path.pdf, path.lamps);
    precise Hit met = Hit(path.way + hit.distance, hit.shape);
    return emission_weight(path.start, met, light, path.pdf, path.lamps);
}

// Light of a sample, scattered at a vertex. `facing`: the true normal on the side of wo; `behind`: what the
// other side absorbs.
void gather_sampled(precise inout Path path, Vertex vertex, LightSample light, vec3 facing, vec3 behind) {
    precise float height = dot(light.ray.direction, facing);
    precise float along = dot(light.ray.direction, vertex.frame[2]);
    if ((HAS_SMOOTH || HAS_NORMAL_MAP) && height * along <= 0.0) light.pdf = 0.0;
    precise vec3 direct = path.scale * path.throughput * direct_light(vertex, light, path.rho);
    if (HAS_ATTENUATION) direct *= share_left(along < 0.0 ? behind : path.absorption, light.distance);
    gather(path, direct, light.layer, path.depth + 1);
}

// What particles that are linked to the camera at the path's first vertex are weighed against: none are, or
// come so far, at a surface that they do not scatter at.
float rho_beyond(Path path, Vertex vertex, Surface surface) {
    if (!carries_particles(vertex.material)) return 0.0;
    if (path.depth > 0 && (LINKED == 0 || path.chain.state == BROKEN)) return path.rho;
    if (is_delta(vertex.material)) return 0.0;
    if (path.depth > 0) return rho_of_link(path.chain, surface.position, vertex.wo.z);
    precise float distance = length(surface.position - path.ray.origin);
    precise float rho = pdf_film(path.ray.direction, vertex.wo.z, distance) / frame.particles;
    return rho;
}

// The share of the sky's light that scattering may count.
float sky_weight(Path path) {
    if (path.pdf == 0.0) return 1.0;
    precise float light_pdf = pdf_sky(path.ray.direction);
    if (light_pdf == 0.0) return 1.0;
    return WEIGHT_BOTH ? power_heuristic(path.pdf, light_pdf) : 0.0;
}

// The sun, where a path that meets nothing meets it.
void gather_sun(precise inout Path path) {
    if (!meets_sun(path.ray.direction)) return;
    precise vec3 light = path.scale * path.throughput * frame.sun_radiance;
    if (HAS_ATTENUATION) light *= share_left_of_sky(path.absorption);
    if (SAMPLE_SUN && path.pdf > 0.0) light *= WEIGHT_BOTH ? power_heuristic(path.pdf, pdf_sun()) : 0.0;
    gather(path, light, SUN_LAYER, path.depth);
}

// Scatters at a surface, after gathering direct light there; false when the path ends.
bool scatter_path(precise inout Path path, Surface surface, Material material, precise inout Sampler rng) {
    leave_vertex(rng.seed, path.depth + 1);
    if (HAS_TRANSMISSION && material.kind == PRINCIPLED) material = met_part(material, next_1d(rng));
    precise vec3 facing = true_normal(surface);
    precise float side = dot(path.ray.direction, facing) < 0.0 ? 1.0 : -1.0;  // 1: outer
    facing *= side;
    precise vec3 shaded = HAS_NORMAL_MAP ? bent_normal(path.ray, surface) : surface.normal;
    precise mat3 around = shading_frame(facing, side * shaded, path.ray.direction);
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
    if (HAS_PARTICLES) path.rho = rho_beyond(path, vertex, surface);
    if (SAMPLE_LIGHTS && !is_delta(material)) {
        precise LightSample light = sample_light(ray, lamps, rng);
        gather_sampled(path, vertex, light, facing, behind);
    }
    if (SAMPLE_SKY && !is_delta(material)) {
        precise LightSample light = sample_sky(ray, rng);
        gather_sampled(path, vertex, light, facing, behind);
    }
    if (SAMPLE_SUN && !is_delta(material)) {
        precise LightSample light = sample_sun(ray, rng);
        gather_sampled(path, vertex, light, facing, behind);
    }
    precise Scattering next = sample_material(vertex, rng);
    if (LINKED != 0) follow_chain(path.chain, surface.shape, vertex, next.crosses);
    if ((HAS_SMOOTH || HAS_NORMAL_MAP) && (dot(next.direction, facing) < 0.0) != next.crosses) return false;
    path.throughput *= next.weight;
    if (path.throughput == vec3(0.0)) return false;
    if (HAS_DIELECTRIC) path.scale *= next.scale;
    if (ROULETTE && roulette_ends(path.throughput, rng)) return false;
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
            if (SAMPLE_SKY) sky *= sky_weight(path);
            gather(path, sky, BACKGROUND_LAYER, path.depth);
        }
        if (HAS_SUN) gather_sun(path);
        return false;
    }
    precise Surface surface = surface_at(path.ray, hit);
    precise Material material = material_of(path.ray, surface);
    precise float share = weight_of_emission(path, hit, surface.light);
    bool facing = dot(path.ray.direction, true_normal(surface)) < 0.0;
    if (HAS_ATTENUATION) absorb(path, material, !facing, hit.distance);
    if (HAS_NESTED && passes(path, surface, material, facing)) return true;
    if (HAS_HOLE && passes_hole(path, surface, material, hit.distance)) return true;
    precise vec3 emission = emitted(material, -path.ray.direction, facing);
    precise vec3 light = path.scale * path.throughput * emission * share;
    gather(path, light, material.layer, path.depth);
    if (path.depth == frame.bounces) return false;
    return scatter_path(path, surface, material, rng);
}
