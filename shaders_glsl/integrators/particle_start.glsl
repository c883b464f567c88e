// Particles: paths from the lamps. A particle is followed as a path from the camera is, but carries flux, which
// refraction does not scale.

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
            aim = sphere_of(CASTERS, min(int(pick.y * float(casters)), casters - 1));
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
