// Particles on their way. They are linked to the camera at every surface that they meet and that is not smooth.

const float KEEP = 2.0;  // `keep` of ends_at_random: a link costs the same, however little light it brings

// P1 / P0 of a particle at the first surface that it meets, as if that were matte; `distance`: from its lamp.
float kappa_of(int light, Meeting at, float distance) {
    Ray ray = at.ray;
    ray.direction = -ray.direction;
    float sampled = 0.0;
    if (is_from_sky(light)) {
        if (SAMPLE_SKY) sampled = pdf_sky(ray.direction);
    } else if (HAS_SUN && light == SUN_LIGHT) sampled = pdf_sun();
    else sampled = pdf_light(light, ray, distance, total_weight(ray));
    float kappa = sampled * PI / at.vertex.wo.z;
    return kappa;
}

// Whether a path from the camera that arrives from `next.direction` scatters around this normal (`is_flat`: the true
// one), to where the particle comes from.
bool goes_back(Scattering next, Normals normals, bool is_flat) {
    if (next.weight == vec3(0.0)) return false;
    bool crosses = dot(next.direction, normals.facing) < 0.0;
    return crosses == next.crosses && is_flat_towards(normals, next.direction) == is_flat;
}

// Glossy surfaces scatter particles as they scatter camera paths. Smooth glass and metal send a particle to the
// one or two directions from which paths from the camera scatter to where the particle comes from. Some of these paths
// scatter around the true normal, which `met` has, and some around the normal for shading.
Scattering scatter_particle(Vertex met, Normals normals, inout Sampler rng) {
    Vertex vertex = met;  // a copy: glslang 12 never ends on a struct that is made of its own fields
    if (is_glossy(met.material)) vertex = vertex_from(met, normals, met.frame * met.wo);
    Scattering flat_one = sample_material(vertex, rng);
    if (!HAS_SHADING || !is_delta(vertex.material) || normals.shading == normals.facing) return flat_one;
    if (!goes_back(flat_one, normals, true)) flat_one.weight = vec3(0.0);
    vec3 wi = normalized(vertex.frame * vertex.wo);
    if (dot(wi, normals.shading) <= 0.0) return flat_one;
    vertex.frame = frame_around(normals.shading);
    vertex.wo = to_local(vertex.frame, wi);
    Scattering bent_one = sample_material(vertex, rng);
    if (!goes_back(bent_one, normals, false)) return flat_one;
    if (flat_one.weight == vec3(0.0)) return bent_one;
    float choice = next_1d(rng);
    flat_one.weight *= 2.0;
    bent_one.weight *= 2.0;
    if (choice < 0.5) return flat_one;
    return bent_one;
}

// Applies a scattering event to the flux and to the weight of a particle.
void turn_particle(inout Particle self, Vertex vertex, Normals normals, Scattering next) {
    vec3 wi = -self.path.ray.direction;
    vec3 share = next.weight;
    float turn = 1.0;
    float unlike_matte = 1.0;  // P0 over that of a matte surface, which kappa_of assumes
    if (is_mirrored(vertex, next.pdf)) {
        turn = mirrored_turn(normals, wi, next.direction);
        share *= turn;
        if (self.path.depth == 0) self.kappa = 0.0;
    } else if (is_glossy(vertex.material)) {
        Turn linked = turn_of_link(vertex, normals, wi, next.direction);
        float leaving = dot(next.direction, normals.facing);
        bool is_lost = next.pdf == 0.0 || HAS_SHADING && leaving < 0.0 != next.crosses;
        float spread = is_lost ? 0.0 : abs(leaving) / next.pdf;
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

// Whether a particle comes from a visible part of its lamp, which may share its place with others; `back` goes there.
bool is_from_seen(Particle self, Ray back) {
    if (self.light < 0) return true;
    int lamp = light_at(self.light).shape;
    if (self.path.ray.origin_shape != lamp || HAS_SPHERE && up_to_sphere(lamp)) return true;
    return shows(back, lamp);
}

// Follows one segment; false when the particle ends with it. `by_spheres`: see link_to_camera.
bool extend_particle(inout Particle self, bool by_spheres, inout Sampler rng) {
    vec3 direction = self.path.ray.direction;
    Hit hit = closest_hit(self.path.ray);
    if (hit.shape == NO_SHAPE || self.path.depth == frame.bounces) return false;
    Surface surface = surface_at(self.path.ray, hit);
    Material whole = material_of(self.path.ray, surface);
    bool enters = dot(direction, true_normal(surface)) < 0.0;
    if (HAS_COINCIDENT && self.path.depth == 0) {
        Ray back = Ray(surface.position, -direction, surface.shape, !enters);
        if (!is_from_seen(self, back)) return false;
    }
    absorb(self.path, whole, !enters, hit.distance);
    record_vertex(surface.position, true_normal(surface), surface.normal, object_number(surface.shape), hit.distance,
                  self.path.throughput);
    if (HAS_NESTED && is_within_other_glass(self.path, whole, enters)) {
        pass_glass(self.path, surface, whole, enters);
        return true;
    }
    Material material = part_met(whole, rng);
    Meeting at = meet(self.path, surface, material, false);
    if (!is_delta(at.vertex.material)) {
        if (self.path.depth == 0) self.kappa = kappa_of(self.light, at, hit.distance);
        link_to_camera(self, at, by_spheres, rng);
    }
    Scattering next = scatter_particle(at.vertex, at.normals, rng);
    record_scattering(at.vertex.frame[2], next.direction, next.pdf, next.crosses);
    turn_particle(self, at.vertex, at.normals, next);
    if (self.path.throughput == vec3(0.0)) return false;
    if (ROULETTE && ends_at_random(self.path.throughput, KEEP, rng)) return false;
    leave(self.path, at, next);
    return true;
}

// Traces the particles of one lane: as many as a pixel has samples. Returns how many are lost because the driver
// ended a loop early. One loop runs over the segments of all particles, as in add_samples.
int add_particles(int lane, bool by_spheres) {
    if (LINKS_LIGHTS) link_lights(lane, by_spheres);
    int index = frame.first_sample;
    int end = index + frame.sample_count;
    Sampler rng = sampler_at(ivec2(lane, -1), index, frame.seed);
    Particle particle = start_particle(rng);
    while (index < end) {
        if (particle.power != vec3(0.0) && extend_particle(particle, by_spheres, rng)) continue;
        if (loop_was_cut) break;
        index += 1;
        rng = sampler_at(ivec2(lane, -1), index, frame.seed);
        particle = start_particle(rng);
    }
    return end - index;
}
