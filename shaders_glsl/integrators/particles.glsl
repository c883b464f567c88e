// Particles: paths from the lamps, linked to the camera at every matte surface that they meet. What they bring is
// handed to `splat`. A particle is followed as a path from the camera is, but carries flux, which refraction does
// not scale.

struct Particle {
    Path path;       // throughput, and what lies around; no radiance
    vec3 power;      // of the lamp, over the density of leaving it so
    float emission;  // that density, as pdf_emission has it
    float kappa;     // of its path, as particle_weights.glsl has it
    int light;
};

// A point on a lamp, and the normal on the side that a particle leaves from.
struct Leaving {
    vec3 position;
    vec3 normal;
    int material;
    bool is_front;
};

Leaving place_on(Light light, vec2 u, bool back) {
    if (is_of_sphere(light)) {
        precise Sphere sphere = sphere_at(light.shape);
        precise vec3 normal = sample_cone(2.0, u);
        precise vec3 position = sphere.center + sphere.radius * normal;
        return Leaving(position, normal, sphere.material, true);
    }
    precise Quad quad = quad_of(light);
    precise vec3 position = quad.corner + u.x * quad.edge_u + u.y * quad.edge_v;
    precise vec3 normal = back ? -quad.normal : quad.normal;
    return Leaving(position, normal, quad.material, !back);
}

// Towards a sphere, evenly over the cone that it fills; from inside of it, nowhere.
vec3 direction_to(Sphere sphere, vec3 position, vec2 u) {
    precise vec3 away = sphere.center - position;
    precise float drop = cone_of_sphere(away, sphere.radius);
    if (drop == 0.0) return vec3(0.0);
    precise vec3 direction = normalized(frame_around(normalized(away)) * sample_cone(drop, u));
    return direction;
}

Particle start_particle(precise inout Sampler rng) {
    precise vec2 choice = next_2d(rng);
    precise vec2 u = next_2d(rng);
    precise vec2 v = next_2d(rng);
    int index = choose_emitter(choice.x);
    precise Light light = light_at(index);
    precise Leaving leaving = place_on(light, u, choice.y >= 0.5);
    precise vec3 direction = normalized(frame_around(leaving.normal) * sample_cosine_hemisphere(v));
    bool is_front = leaving.is_front;
    int aim = NOT_AIMED;
    if (CASTERS != 0) {
        int casters = bitCount(CASTERS);
        precise vec2 pick = next_2d(rng);
        if (pick.x < frame.aimed) {
            aim = caster(min(int(pick.y * float(casters)), casters - 1));
            direction = direction_to(sphere_at(aim), leaving.position, v);
            if (!is_of_sphere(light)) is_front = dot(direction, quad_of(light).normal) > 0.0;
        }
    }
    precise Path path = start_path(Ray(leaving.position, direction, light.shape, false));
    path.absorption = vec3(0.0);
    path.counts = 0u;
    precise float emission = pdf_emission(index, leaving.position, direction, aim);
    precise vec3 power = vec3(0.0);
    if (emission > 0.0 && direction != vec3(0.0)) power = emitted(material_at(leaving.material), direction, is_front) * (PI / emission);
    return Particle(path, power, emission, 0.0, index);
}

// The place on the film, in pixels of the frame, of a ray that reaches the camera at a place on the lens.
vec2 place_on_film(vec3 direction, vec2 lens) {
    precise vec3 d = direction / dot(direction, frame.camera.forward);
    precise float x = dot(d, frame.camera.right) + frame.camera.tan_lens * lens.x;
    precise float y = dot(d, frame.camera.up) + frame.camera.tan_lens * lens.y;
    precise vec2 share = vec2(x / frame.camera.tan_x + 1.0, 1.0 - y / frame.camera.tan_y);
    precise vec2 place = 0.5 * share * vec2(frame.size);
    return place;
}

// Brings the camera what a particle scatters to it at a matte vertex; `ray` leaves there.
void link_to_camera(Particle self, Vertex vertex, Ray ray, precise inout Sampler rng) {
    precise vec2 lens = vec2(0.0);
    if (HAS_LENS) lens = sample_disk(next_2d(rng));
    precise vec3 eye = frame.camera.lens_radius * (lens.x * frame.camera.right + lens.y * frame.camera.up);
    if (!HAS_LENS) eye = vec3(0.0);
    precise vec3 away = eye - ray.origin;
    precise float distance = length(away);
    ray.direction = away / distance;
    precise vec3 wi = to_local(vertex.frame, ray.direction);
    if (wi.z <= 0.0 || dot(ray.direction, frame.camera.forward) >= 0.0) return;
    precise vec2 place = place_on_film(-ray.direction, lens);
    if (any(lessThan(place, vec2(0.0))) || any(greaterThanEqual(place, vec2(frame.size)))) return;
    precise float pdf = pdf_film(-ray.direction, wi.z, distance);
    precise float weight = particle_weight(pdf / (frame.particles * self.emission), self.kappa);
    precise vec3 flux = self.power * self.path.throughput;
    if (HAS_ATTENUATION) flux *= share_left(self.path.absorption, distance);
    precise vec3 value = flux * (vertex.material.color / PI) * (pdf * weight);
    if (value == vec3(0.0) || occluded(ray, distance, NO_SHAPE)) return;
    splat(place, value);
}

// P1 / P0 of a particle at the first vertex that it meets; `ray` leaves there, in any direction.
float kappa_of(int light, Vertex vertex, Ray ray, vec3 towards, float distance) {
    ray.direction = towards;
    precise float sampled = pdf_light(light, ray, distance, total_weight(ray));
    precise float kappa = sampled * PI / vertex.wo.z;
    return kappa;
}

// Follows one segment; false when the particle ends with it.
bool extend_particle(precise inout Particle self, precise inout Sampler rng) {
    precise vec3 direction = self.path.ray.direction;
    precise Hit hit = closest_hit(self.path.ray);
    if (hit.shape == NO_SHAPE || self.path.depth == frame.bounces) return false;
    precise Surface surface = surface_at(self.path.ray, hit);
    precise Material material = material_of(self.path.ray, surface);
    precise vec3 facing = true_normal(surface);
    precise float side = dot(direction, facing) < 0.0 ? 1.0 : -1.0;  // 1: outer
    facing *= side;
    if (HAS_ATTENUATION) absorb(self.path, material, side < 0.0, hit.distance);
    if (!carries_particles(material)) return false;
    precise mat3 around = frame_around(facing);
    precise Vertex vertex = vertex_of(around, to_local(around, -direction), material, side > 0.0);
    precise Ray ray = Ray(surface.position, direction, surface.shape, side < 0.0);
    if (!is_delta(material)) {
        if (self.path.depth == 0) self.kappa = kappa_of(self.light, vertex, ray, -direction, hit.distance);
        link_to_camera(self, vertex, ray, rng);
    }
    precise vec3 behind = HAS_ATTENUATION ? absorption_behind(self.path, material, side > 0.0) : vec3(0.0);
    precise Scattering next = sample_material(vertex, rng);
    self.path.throughput *= next.weight;
    if (self.path.throughput == vec3(0.0)) return false;
    if (ROULETTE && roulette_ends(self.path.throughput, rng)) return false;
    ray.direction = next.direction;
    ray.inward = (side < 0.0) != next.crosses;
    self.path.ray = ray;
    if (HAS_ATTENUATION && next.crosses) self.path.absorption = behind;
    self.path.depth += 1;
    return true;
}

// The particles of one lane: as many as there are samples of a pixel. Returns how many are lost because the driver
// ended a loop early. One loop over the segments of all, as in add_samples.
int add_particles(int lane) {
    int index = frame.first_sample;
    int end = index + frame.sample_count;
    precise Sampler rng = sampler_at(ivec2(lane, -1), index, frame.seed);
    precise Particle particle = start_particle(rng);
    while (index < end) {
        if (particle.power != vec3(0.0) && extend_particle(particle, rng)) continue;
        if (loop_was_cut) break;
        index += 1;
        rng = sampler_at(ivec2(lane, -1), index, frame.seed);
        particle = start_particle(rng);
    }
    return end - index;
}
