// Particles on their way, linked to the camera at every surface that they meet and that is not smooth.

const float KEEP = 2.0;  // as ends_at_random has it: a link of a particle costs the same, however little it brings

// P1 / P0 of a particle at the first vertex that it meets, as if that were matte; `ray` leaves there, in any direction.
float kappa_of(int light, Vertex vertex, Ray ray, vec3 towards, float distance) {
    ray.direction = towards;
    precise float sampled = 0.0;
    if (SKY_SENDS) {
        if (SAMPLE_SKY) sampled = pdf_sky(towards);
    } else if (HAS_SUN && light == SUN_LIGHT) sampled = pdf_sun();
    else sampled = pdf_light(light, ray, distance, total_weight(ray));
    precise float kappa = sampled * PI / vertex.wo.z;
    return kappa;
}

// Whether a path from the camera that comes from where a particle goes scatters around that normal, to where the
// particle comes from.
bool goes_back(Scattering next, Normals normals, bool is_flat) {
    if (next.weight == vec3(0.0)) return false;
    bool crosses = dot(next.direction, normals.facing) < 0.0;
    return crosses == next.crosses && is_flat_towards(normals, next.direction) == is_flat;
}

// Glossy surfaces scatter particles as paths from the camera. So do smooth glass and metal, in the one or two directions
// from which paths from the camera come to where the particle comes from: some of these scatter around the true normal,
// which `vertex` has, some around the other one.
Scattering scatter_particle(Vertex met, Normals normals, precise inout Sampler rng) {
    precise Vertex vertex = met;  // a struct made of its own fields keeps glslang 12 searching for ever
    if (is_glossy(met.material)) vertex = vertex_from(met, normals, met.frame * met.wo);
    precise Scattering flat_one = sample_material(vertex, rng);
    if (!HAS_SHADING || !is_delta(vertex.material) || normals.shading == normals.facing) return flat_one;
    if (!goes_back(flat_one, normals, true)) flat_one.weight = vec3(0.0);
    precise vec3 wi = normalized(vertex.frame * vertex.wo);
    if (dot(wi, normals.shading) <= 0.0) return flat_one;
    vertex.frame = frame_around(normals.shading);
    vertex.wo = to_local(vertex.frame, wi);
    precise Scattering bent_one = sample_material(vertex, rng);
    if (!goes_back(bent_one, normals, false)) return flat_one;
    if (flat_one.weight == vec3(0.0)) return bent_one;
    precise float choice = next_1d(rng);
    flat_one.weight *= 2.0;
    bent_one.weight *= 2.0;
    if (choice < 0.5) return flat_one;
    return bent_one;
}

// What scattering makes of its flux and of its weight.
void turn_particle(precise inout Particle self, Vertex vertex, Normals normals, Scattering next) {
    precise vec3 wi = -self.path.ray.direction;
    precise vec3 share = next.weight;
    precise float turn = 1.0;
    precise float unlike_matte = 1.0;  // P0 over that of a matte surface, which kappa_of has
    if (is_glossy(vertex.material)) {
        precise Turn linked = turn_of_link(vertex, normals, wi, next.direction);
        precise float leaving = dot(next.direction, normals.facing);
        bool is_lost = next.pdf == 0.0 || HAS_SHADING && leaving < 0.0 != next.crosses;
        precise float spread = is_lost ? 0.0 : abs(leaving) / next.pdf;
        turn = linked.turn * spread / PI;
        share = turn > 0.0 && turn < FAR ? linked.value * spread : vec3(0.0);
        unlike_matte = linked.turn;
    } else if (HAS_SHADING) {
        turn = turn_towards(normals, wi, next.direction, is_delta(vertex.material));
        share *= turn;
        unlike_matte = turn;
    }
    self.path.throughput *= share;
    self.turn *= turn;
    if (self.path.depth == 0 && turn > 0.0) self.kappa /= unlike_matte;
}

// Whether a particle comes from what is seen of its lamp, in a place that the lamp may share; `back` goes there.
bool is_from_seen(Particle self, Ray back) {
    if (self.light < 0) return true;
    int lamp = light_at(self.light).shape;
    if (self.path.ray.origin_shape != lamp || HAS_SPHERE && up_to_sphere(lamp)) return true;
    return shows(back, lamp);
}

// Follows one segment; false when the particle ends with it. `by_spheres`: as link_to_camera has it.
bool extend_particle(precise inout Particle self, bool by_spheres, precise inout Sampler rng) {
    precise vec3 direction = self.path.ray.direction;
    precise Hit hit = closest_hit(self.path.ray);
    if (hit.shape == NO_SHAPE || self.path.depth == frame.bounces) return false;
    precise Surface surface = surface_at(self.path.ray, hit);
    precise Material material = material_of(self.path.ray, surface);
    precise vec3 facing = true_normal(surface);
    precise float side = dot(direction, facing) < 0.0 ? 1.0 : -1.0;  // 1: outer
    facing *= side;
    if (HAS_COINCIDENT && self.path.depth == 0) {
        precise Ray back = Ray(surface.position, -direction, surface.shape, side < 0.0);
        if (!is_from_seen(self, back)) return false;
    }
    if (HAS_ATTENUATION) absorb(self.path, material, side < 0.0, hit.distance);
    record_vertex(surface.position, true_normal(surface), surface.normal, object_number(surface.shape), hit.distance,
                  self.path.throughput);
    if (HAS_NESTED && passes(self.path, surface, material, side > 0.0)) return true;
    if (HAS_TRANSMISSION && material.kind == PRINCIPLED) material = met_part(material, next_1d(rng));
    if (!carries_particles(material)) return false;
    precise mat3 around = frame_around(facing);
    precise Vertex vertex = vertex_of(around, to_local(around, -direction), material, side > 0.0);
    precise Ray ray = Ray(surface.position, direction, surface.shape, side < 0.0);
    precise Normals normals = Normals(facing, facing);
    if (HAS_SHADING) normals.shading = side * (HAS_NORMAL_MAP ? bent_normal(self.path.ray, surface) : surface.normal);
    uint beyond = self.path.counts;
    if (is_medium(material)) {
        beyond = counts_beyond(self.path.counts, material.details, side > 0.0);
        vertex.eta = ior_of_medium(self.path.counts) / ior_of_medium(beyond);
    }
    precise vec3 behind = HAS_ATTENUATION ? absorption_behind(self.path, material, side > 0.0) : vec3(0.0);
    if (!is_delta(material)) {
        if (self.path.depth == 0) self.kappa = kappa_of(self.light, vertex, ray, -direction, hit.distance);
        link_to_camera(self, vertex, normals, ray, behind, by_spheres, rng);
    }
    precise Scattering next = scatter_particle(vertex, normals, rng);
    record_scattering(vertex.frame[2], next.direction, next.pdf, next.crosses);
    turn_particle(self, vertex, normals, next);
    if (self.path.throughput == vec3(0.0)) return false;
    if (ROULETTE && ends_at_random(self.path.throughput, KEEP, rng)) return false;
    ray.direction = next.direction;
    ray.inward = (side < 0.0) != next.crosses;
    self.path.ray = ray;
    if (HAS_ATTENUATION && next.crosses) self.path.absorption = behind;
    if (HAS_NESTED && next.crosses) self.path.counts = beyond;
    self.path.depth += 1;
    return true;
}

// The particles of one lane: as many as there are samples of a pixel. Returns how many are lost because the driver
// ended a loop early. One loop over the segments of all, as in add_samples.
int add_particles(int lane, bool by_spheres) {
    int index = frame.first_sample;
    int end = index + frame.sample_count;
    precise Sampler rng = sampler_at(ivec2(lane, -1), index, frame.seed);
    precise Particle particle = start_particle(rng);
    while (index < end) {
        if (particle.power != vec3(0.0) && extend_particle(particle, by_spheres, rng)) continue;
        if (loop_was_cut) break;
        index += 1;
        rng = sampler_at(ivec2(lane, -1), index, frame.seed);
        particle = start_particle(rng);
    }
    return end - index;
}
