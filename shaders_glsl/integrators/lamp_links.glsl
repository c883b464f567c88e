// Links of lamps to the camera, from the points where particles leave them: straight, or through one sphere. This
// light meets no rough surface, and nothing absorbs it, since no lamp is in tinted glass. `splat` takes the value that
// a link brings.

// The side of a flat lamp that faces `direction`, whichever side the particle leaves.
Leaving facing(Particle self, vec3 direction) {
    Leaving start = self.start;
    if (is_sphere_lamp(light_at(self.light).shape) || dot(direction, start.normal) > 0.0) return start;
    return Leaving(start.position, -start.normal, start.material, !start.is_front);
}

// Links the point straight to the eye.
void link_lamp_straight(Particle self, Eye eye) {
    vec3 away = eye.position - self.start.position;
    float distance = length(away);
    vec3 direction = away / distance;
    Leaving start = facing(self, direction);
    float cosine = dot(direction, start.normal);
    if (cosine <= 0.0 || dot(direction, frame.camera.forward) >= 0.0) return;
    vec2 place = place_on_film(-direction, eye.lens);
    float density = density_on_lamp(self.light, start.position, direction);
    if (density == 0.0 || !is_on_film(place)) return;
    float seen = pdf_film(-direction, cosine, distance);
    float linked = frame.particles * density;
    float weight = weight_of_lamp_link(seen / linked);
    vec3 radiance = emitted(material_at(start.material), direction, start.is_front);
    vec3 value = radiance * (frame.particles * seen * weight / linked);
    Ray ray = Ray(start.position, direction, self.path.ray.origin_shape, false);
    if (value == vec3(0.0) || occluded(ray, distance, NO_SHAPE)) return;
    record_link(linked, seen, weight);
    splat(place, value, layer_of(self, 0));
}

// Links the point to the eye through one sphere, by one way drawn at random.
void link_lamp_through_sphere(Particle self, Eye eye, inout Sampler rng) {
    Through link;
    if (!draw_link(self.start.position, 0, eye, rng, link)) return;
    Leaving start = facing(self, link.direction);
    float cosine = dot(link.direction, start.normal);
    if (cosine <= 0.0) return;
    float density = density_on_lamp(self.light, start.position, link.direction);
    float rho = rho_of_drawn(link, cosine);
    if (density == 0.0 || rho == 0.0) return;
    float weight = weight_of_lamp_link(rho / density);
    vec3 radiance = emitted(material_at(start.material), link.direction, start.is_front);
    radiance *= tint_of(link.material, link.arc, link.at);
    vec3 value = radiance * (frame.particles * rho * weight / density);
    Ray ray = Ray(start.position, link.direction, self.path.ray.origin_shape, false);
    if (value == vec3(0.0) || is_hidden(link, ray, eye)) return;
    record_link(density, rho, weight);
    splat(link.place, value, layer_of(self, 1 + link.arc.chords));
}

// Links the point where a particle left its lamp. `by_spheres`: also through one of the linked spheres.
void link_lamp(Particle self, bool by_spheres, inout Sampler rng) {
    if (self.light < 0) return;
    Eye eye = sample_eye(rng);
    link_lamp_straight(self, eye);
    int tries = LINKED != 0 && by_spheres ? 1 : 0;  // a loop, as in link_to_camera
    for (int i = 0; i < tries; ++i) link_lamp_through_sphere(self, eye, rng);
}

// Links what the particles of one lane leave, before any of them is followed: lanes stay together.
void link_lamps(int lane, bool by_spheres) {
    int i = 0;
    for (; i < frame.sample_count; ++i) {
        Sampler rng = sampler_at(ivec2(lane, -1), frame.first_sample + i, frame.seed);
        Particle particle = start_particle(rng);
        link_lamp(particle, by_spheres, rng);
    }
    note_end(i, frame.sample_count);
}
