// Particles: paths from the lamps. A particle is followed like a path from the camera, but it carries flux, which
// refraction does not scale.

// A point on a lamp, and the normal on the side where a particle leaves.
struct Leaving {
    vec3 position;
    vec3 normal;
    int material;
    bool is_front;
};

const Leaving FROM_AFAR = Leaving(vec3(0.0), vec3(0.0), 0, true);

struct Particle {
    Path path;       // throughput and the media around the path; no radiance
    vec3 power;      // of the lamp, over the density `emission`
    float emission;  // density of leaving the lamp this way, from pdf_emission
    float kappa;     // of its path, see particle_weights.glsl
    float turn;      // P0 over PL of its scattering events so far
    int light;
    int layer;       // of the light group of the lamp
    Leaving start;   // FROM_AFAR for the sun and the sky
};

Leaving leave_flat(vec3 position, vec3 normal, int material, bool back) {
    return Leaving(position, back ? -normal : normal, material, !back);
}

Leaving place_on(Light light, vec2 u, bool back) {
    if (is_sphere_lamp(light.shape)) {
        Sphere sphere = sphere_at(light.shape);
        vec3 normal = sample_cone(2.0, u);
        vec3 position = sphere.center + sphere.radius * normal;
        return Leaving(position, normal, sphere.material, true);
    }
    if (is_triangle_lamp(light.shape)) {
        LampTriangle triangle = lamp_triangle(light.shape);
        vec2 shares = sample_triangle(u);
        vec3 place = triangle.a + shares.x * triangle.edge_b + shares.y * triangle.edge_c;
        return leave_flat(place, normalized(triangle.across), mesh_at(triangle.mesh).material, back);
    }
    if (is_disk_lamp(light.shape)) {
        Disk disk = disk_lamp(light.shape);
        vec2 across = disk.radius * sample_disk(u);
        vec3 place = disk.center + frame_around(disk.normal) * vec3(across, 0.0);
        return leave_flat(place, disk.normal, disk.material, back);
    }
    if (is_quad_lamp(light.shape)) {
        Quad quad = quad_lamp(light.shape);
        vec3 position = quad.corner + u.x * quad.edge_u + u.y * quad.edge_v;
        return leave_flat(position, quad.normal, quad.material, back);
    }
    return FROM_AFAR;
}

// A direction towards a ball, drawn evenly over the cone that the ball fills; 0 from inside the ball.
vec3 direction_to(Target ball, vec3 position, vec2 u) {
    vec3 away = ball.center - position;
    float drop = cone_of_sphere(away, ball.radius);
    if (drop == 0.0) return vec3(0.0);
    vec3 direction = normalized(frame_around(normalized(away)) * sample_cone(drop, u));
    return direction;
}

Path particle_path(Ray ray) {
    Path path = start_path(ray);
    path.absorption = vec3(0.0);
    path.counts = 0u;
    return path;
}

// The point where light on the line through p begins: before it meets the ball around the scene, or a plane.
vec3 before_the_scene(vec3 p, vec3 direction) {
    float along = dot(p - frame.bounds_center, direction);
    vec3 start = p - (along + 2.0 * frame.bounds_radius) * direction;
    if (!HAS_PLANE) return start;
    float farthest = 0.0;
    int i = 0;
    for (; i < plane_count(); ++i) {
        Plane plane = plane_at(i);
        float t = plane_distance(Ray(start, -direction, NO_SHAPE, false), plane.point, plane.normal);
        if (t > farthest && t < FAR) farthest = t;
    }
    note_end(i, plane_count());
    start -= 2.0 * farthest * direction;
    return start;
}

// `aim`: the number of the target, or NOT_AIMED.
Particle start_from_sun(int aim, vec2 u, vec2 v) {
    vec3 towards = normalized(frame_around(frame.sun_direction) * sample_cone(frame.sun_versine, u));
    Target ball = Target(frame.bounds_center, frame.bounds_radius);
    if (aim != NOT_AIMED) ball = aimed_at(aim);
    vec3 across = frame_around(towards) * vec3(ball.radius * sample_disk(v), 0.0);
    Ray ray = Ray(before_the_scene(ball.center + across, -towards), -towards, NO_SHAPE, false);
    float emission = pdf_from_sun(ray.origin, -towards, aim);
    vec3 power = vec3(0.0);
    if (emission > 0.0) power = frame.sun_radiance * (PI / emission);
    return Particle(particle_path(ray), power, emission, 0.0, 1.0, SUN_LIGHT, SUN_LAYER, FROM_AFAR);
}

// `aim`: see start_from_sun.
Particle start_from_sky(int aim, vec2 v, inout Sampler rng) {
    vec3 towards = vec3(0.0);
    if (HAS_ENVIRONMENT) towards = sample_sky(Ray(vec3(0.0), vec3(0.0), NO_SHAPE, false), rng).ray.direction;
    else towards = sample_cone(2.0, next_2d(rng));
    Target ball = Target(frame.bounds_center, frame.bounds_radius);
    if (aim != NOT_AIMED) ball = aimed_at(aim);
    vec3 across = frame_around(towards) * vec3(ball.radius * sample_disk(v), 0.0);
    Ray ray = Ray(before_the_scene(ball.center + across, -towards), -towards, NO_SHAPE, false);
    float emission = pdf_from_sky(ray.origin, -towards, aim);
    vec3 power = vec3(0.0);
    if (emission > 0.0) power = background(towards) * (PI / emission);
    return Particle(particle_path(ray), power, emission, 0.0, 1.0, SKY_LIGHT, BACKGROUND_LAYER, FROM_AFAR);
}

Particle start_particle(inout Sampler rng) {
    vec2 choice = next_2d(rng);
    vec2 u = next_2d(rng);
    vec2 v = next_2d(rng);
    int aim = NOT_AIMED;
    if (is_aimed()) {
        vec2 pick = next_2d(rng);
        if (pick.x < frame.aimed) aim = choose_aim(pick.y);
    }
    if (SKY_SENDS) {
        if (ONLY_SKY_SENDS || choice.x < frame.from_sky) return start_from_sky(aim, v, rng);
        choice.x -= frame.from_sky;
    }
    if (HAS_SUN) {
        if (CLUSTERS == 0 || choice.x < frame.from_sun) return start_from_sun(aim, u, v);
        choice.x -= frame.from_sun;
    }
    if (SKY_SENDS || HAS_SUN) choice.x /= share_of_lamps();
    int index = choose_emitter(choice.x);
    Light light = light_at(index);
    float front = sides_at(index).front;
    Leaving leaving = place_on(light, u, choice.y >= front);
    vec3 direction = normalized(frame_around(leaving.normal) * sample_cosine_hemisphere(v));
    bool is_front = leaving.is_front;
    if (aim != NOT_AIMED) {
        direction = direction_to(aimed_at(aim), leaving.position, v);
        if (!is_sphere_lamp(light.shape)) is_front = dot(direction, leaving.normal) > 0.0 == leaving.is_front;
    }
    float emission = pdf_emission(index, leaving.position, direction, aim);
    Material material = material_at(leaving.material);
    vec3 power = vec3(0.0);
    if (emission > 0.0 && direction != vec3(0.0)) power = emitted(material, direction, is_front) * (PI / emission);
    Path path = particle_path(Ray(leaving.position, direction, light.shape, false));
    return Particle(path, power, emission, 0.0, 1.0, index, material.layer, leaving);
}
