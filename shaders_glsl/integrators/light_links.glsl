// Links of lights to the camera, from where particles begin: straight, or through one sphere. This light meets no rough
// surface, and nothing absorbs it, since no light is in tinted glass. `splat` takes the value that a link brings.

// The side of a flat lamp that faces `direction`, whichever side the particle leaves.
Leaving facing(Particle self, vec3 direction) {
    Leaving start = self.start;
    if (is_sphere_lamp(light_at(self.light).shape) || dot(direction, start.normal) > 0.0) return start;
    return Leaving(start.position, -start.normal, start.material, !start.is_front);
}

// Adds light that reaches the film at a place, by a way of the density `rho`. `emission`: its radiance where it begins;
// `density`: of the particles there.
void add_light(Particle self, vec3 emission, vec3 tint, vec2 place, float rho, float density, int events) {
    float weight = weight_of_light_link(rho / density);
    record_link(emission, density, rho, weight);
    splat(place, emission * tint * (frame.particles * rho * weight / density), layer_of(self, events));
}

// Links the point on a lamp straight to the eye.
void link_lamp_straight(Particle self, Eye eye) {
    vec3 away = eye.position - self.start.position;
    float distance = length(away);
    vec3 direction = away / distance;
    Leaving start = facing(self, direction);
    float cosine = dot(direction, start.normal);
    if (cosine <= 0.0 || dot(direction, frame.camera.forward) >= 0.0) return;
    vec2 place = place_on_film(-direction, eye.lens);
    float density = density_on_lamp(self.light, start.position, direction);
    vec3 emission = emitted(material_at(start.material), direction, start.is_front);
    if (density == 0.0 || emission == vec3(0.0) || !is_on_film(place)) return;
    if (occluded(Ray(start.position, direction, self.path.ray.origin_shape, false), distance, NO_SHAPE)) return;
    float rho = pdf_film(-direction, cosine, distance) / frame.particles;
    add_light(self, emission, vec3(1.0), place, rho, density, 0);
}

// Links it to the eye through one sphere, by one way drawn at random.
void link_lamp_through_sphere(Particle self, Eye eye, inout Sampler rng) {
    Through link = draw_link(self.start.position, 0, eye, rng);
    if (link.sphere == NO_SHAPE) return;
    Leaving start = facing(self, link.direction);
    float cosine = dot(link.direction, start.normal);
    if (cosine <= 0.0) return;
    float density = density_on_lamp(self.light, start.position, link.direction);
    float rho = rho_of_drawn(link, cosine);
    vec3 emission = emitted(material_at(start.material), link.direction, start.is_front);
    if (density == 0.0 || rho == 0.0 || emission == vec3(0.0)) return;
    Ray ray = Ray(start.position, link.direction, self.path.ray.origin_shape, false);
    if (is_hidden(link, ray, link.distance, eye)) return;
    vec3 tint = tint_of(link.material, link.arc, link.at);
    add_light(self, emission, tint, link.place, rho, density, 1 + link.arc.chords);
}

// Radiance of the sun or the sky in the direction `towards`.
vec3 emitted_from_afar(int light, vec3 towards) {
    return HAS_SUN && light == SUN_LIGHT ? frame.sun_radiance : background(towards);
}

// Links the place of the sun or the sky where a particle comes from, straight.
void link_afar_straight(Particle self, Eye eye) {
    vec3 towards = -self.path.ray.direction;
    vec2 place = place_on_film(towards, eye.lens);
    float density = density_of_afar(self.light, towards);
    if (dot(towards, frame.camera.forward) <= 0.0 || !is_on_film(place) || density == 0.0) return;
    if (occluded(Ray(eye.position, towards, NO_SHAPE, false), FAR, NO_SHAPE)) return;
    vec3 emission = emitted_from_afar(self.light, towards);
    add_light(self, emission, vec3(1.0), place, pdf_camera(towards) / frame.particles, density, 0);
}

// The same through one sphere.
void link_afar_through_sphere(Particle self, Eye eye, inout Sampler rng) {
    vec3 towards = -self.path.ray.direction;
    Draw drawn = draw_sphere(rng);
    Arc arc = arc_to_afar(eye.position, towards, sphere_at(drawn.sphere), drawn.material.ior, drawn.chords);
    Through link = find_link(drawn, arc, 0, eye);
    if (link.sphere == NO_SHAPE) return;
    float density = density_of_afar(self.light, towards);
    float rho = rho_of_drawn(link, 1.0);
    if (density == 0.0 || rho == 0.0) return;
    if (is_hidden(link, Ray(link.way.far, towards, link.sphere, false), FAR, eye)) return;
    vec3 tint = tint_of(link.material, link.arc, link.at);
    vec3 emission = emitted_from_afar(self.light, towards);
    add_light(self, emission, tint, link.place, rho, density, 1 + link.arc.chords);
}

// Links what a particle leaves. `by_spheres`: also through one of the linked spheres.
void link_light(Particle self, bool by_spheres, inout Sampler rng) {
    Eye eye = sample_eye(rng);
    bool is_afar = (HAS_SUN || SKY_SENDS) && (CLUSTERS == 0 || self.light < 0);
    if (is_afar) link_afar_straight(self, eye);
    else link_lamp_straight(self, eye);
    int tries = LINKED != 0 && by_spheres ? 1 : 0;  // a loop, as in link_to_camera
    for (int i = 0; i < tries; ++i) {
        if (is_afar) link_afar_through_sphere(self, eye, rng);
        else link_lamp_through_sphere(self, eye, rng);
    }
}

// Links what the particles of one lane leave, before any of them is followed: lanes stay together.
void link_lights(int lane, bool by_spheres) {
    int i = 0;
    for (; i < frame.sample_count; ++i) {
        Sampler rng = sampler_at(ivec2(lane, -1), frame.first_sample + i, frame.seed);
        Particle particle = start_particle(rng);
        link_light(particle, by_spheres, rng);
    }
    note_end(i, frame.sample_count);
}
