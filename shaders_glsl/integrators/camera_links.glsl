// Links of particles to the camera, from a vertex that is not smooth: straight, or through one sphere. `splat` takes
// the value that a link brings.

// The layer of the film that takes light which reaches the camera after `length` scattering events.
int layer_of(Particle self, int length) {
    return LAYERS == 0 ? 0 : min(BY_LENGTH ? length : self.layer, LAYERS - 1);
}

// The place on the film, in pixels of the frame, of a ray that reaches the camera at the point `lens` of the lens.
vec2 place_on_film(vec3 direction, vec2 lens) {
    vec3 d = direction / dot(direction, frame.camera.forward);
    float x = dot(d, frame.camera.right) + frame.camera.tan_lens * lens.x;
    float y = dot(d, frame.camera.up) + frame.camera.tan_lens * lens.y;
    vec2 share = vec2(x / frame.camera.tan_x + 1.0, 1.0 - y / frame.camera.tan_y);
    vec2 place = 0.5 * share * vec2(frame.size);
    return place;
}

bool is_on_film(vec2 place) {
    return all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(frame.size)));
}

// A point of the lens.
struct Eye {
    vec2 lens;  // its place on the unit disk
    vec3 position;
};

Eye sample_eye(inout Sampler rng) {
    if (!HAS_LENS) return Eye(vec2(0.0), vec3(0.0));
    vec2 lens = sample_disk(next_2d(rng));
    vec3 position = frame.camera.lens_radius * (lens.x * frame.camera.right + lens.y * frame.camera.up);
    return Eye(lens, position);
}

// Weight of a particle that is linked by a way with the density `rho`: P0 over the density of particles. `turn`: the
// turn of this vertex from turn_of_link, above 0.
float weight_of_link(Particle self, float rho, float turn) {
    if (!(HAS_SHADING || HAS_GLOSSY)) return particle_weight(rho, self.kappa);
    float kappa = self.path.depth == 0 ? self.kappa / turn : self.kappa;
    float turned = rho * self.turn * turn;
    return particle_weight(turned, kappa);
}

// Whether a link may leave a vertex in the direction wi, given in the frame of the vertex. Sets the side of the ray.
bool leaves_so(Vertex vertex, vec3 wi, inout Ray ray) {
    bool crosses = wi.z < 0.0;
    if (crosses) ray.inward = !ray.inward;
    return wi.z > 0.0 || crosses && scatters_across(vertex.material);
}

// Links a particle straight to the eye and adds the light that it scatters there.
void link_straight(Particle self, Meeting at, Eye eye) {
    Ray ray = at.ray;
    vec3 away = eye.position - ray.origin;
    float distance = length(away);
    ray.direction = away / distance;
    vec3 wi = to_local(at.vertex.frame, ray.direction);
    if (!leaves_so(at.vertex, wi, ray) || dot(ray.direction, frame.camera.forward) >= 0.0) return;
    vec2 place = place_on_film(-ray.direction, eye.lens);
    if (!is_on_film(place)) return;
    Turn turn = turn_of_link(at.vertex, at.normals, -self.path.ray.direction, ray.direction);
    if (turn.turn == 0.0) return;
    float pdf = pdf_film(-ray.direction, abs(wi.z), distance);
    float weight = weight_of_link(self, pdf / (frame.particles * self.emission), turn.turn);
    vec3 flux = self.power * self.path.throughput;
    if (HAS_ATTENUATION) flux *= share_left(wi.z < 0.0 ? at.behind : self.path.absorption, distance);
    vec3 value = flux * turn.value * (pdf * weight);
    if (value == vec3(0.0) || occluded(ray, distance, NO_SHAPE)) return;
    record_link(frame.particles * self.emission, pdf, weight);
    splat(place, value, layer_of(self, self.path.depth + 1));
}

// The two points where a way through a sphere meets it: `near` on the side of the eye, `far` on that of the vertex.
struct Way {
    vec3 near;
    vec3 far;
    vec3 direction;  // unit, from the eye
};

// `sense`: the result of sense_of.
Way way_of(Arc arc, vec3 center, Crossing at, float sense) {
    vec2 sines = arc.ratios.xy * at.sine;
    vec2 cos_turn = at.cosine * at.cosines.xy + at.sine * sines;  // from the eye and from the vertex
    vec2 sin_turn = at.sine * at.cosines.xy - at.cosine * sines;
    float scale = sense / arc.sine;
    vec3 from_eye = scale * (arc.to_vertex - arc.cosine * arc.to_eye);  // unit, across to_eye
    vec3 from_vertex = scale * (arc.to_eye - arc.cosine * arc.to_vertex);
    vec3 near = center + arc.radius * (cos_turn.x * arc.to_eye + sin_turn.x * from_eye);
    vec3 far = center + arc.radius * (cos_turn.y * arc.to_vertex + sin_turn.y * from_vertex);
    vec3 direction = normalized(sines.x * from_eye - at.cosines.x * arc.to_eye);
    return Way(near, far, direction);
}

// Links a particle to the eye through one sphere, by one way drawn at random, and adds the light.
void link_through_sphere(Particle self, Meeting from, Eye eye, inout Sampler rng) {
    Ray ray = from.ray;
    vec2 pick = next_2d(rng);
    float by_branch = next_1d(rng);
    int count = bitCount(LINKED);
    int index = sphere_of(LINKED, min(int(pick.x * float(count)), count - 1));
    Sphere sphere = sphere_at(index);
    Material material = material_at(sphere.material);
    int chords = draw_chords(material, pick.y);
    Arc arc = arc_of(eye.position, ray.origin, sphere, material.ior, chords);
    if (self.path.depth + 2 + chords > frame.bounces || !has_links(arc)) return;
    Branch branch = draw_branch(arc, by_branch);
    float half_tangent = meeting_of(arc, branch);
    if (half_tangent < 0.0) return;
    Crossing at = crossing_of(arc, incidence_of(half_tangent).sine);
    Way way = way_of(arc, sphere.center, at, sense_of(branch, chords));
    vec3 away = way.far - ray.origin;
    float distance = length(away);
    ray.direction = away / distance;
    vec3 wi = to_local(from.vertex.frame, ray.direction);
    vec2 place = place_on_film(way.direction, eye.lens);
    bool is_seen = dot(way.direction, frame.camera.forward) > 0.0 && is_on_film(place);
    if (!leaves_so(from.vertex, wi, ray) || !is_seen) return;
    float film = pdf_camera(way.direction);
    float rho = pdf_of_way(film, material, arc, at, abs(wi.z)) / linked_this_way(material, arc, at);
    if (rho == 0.0) return;  // no link: with an infinite kappa its weight would be 0
    Turn turn = turn_of_link(from.vertex, from.normals, -self.path.ray.direction, ray.direction);
    if (turn.turn == 0.0) return;
    float weight = weight_of_link(self, rho / self.emission, turn.turn);
    vec3 back = eye.position - way.near;
    float reach = length(back);
    vec3 flux = self.power * self.path.throughput * tint_of(material, arc, at);
    if (HAS_ATTENUATION) flux *= share_left(wi.z < 0.0 ? from.behind : self.path.absorption, distance + reach);
    vec3 value = flux * turn.value * (frame.particles * rho * weight);
    if (value == vec3(0.0) || occluded(ray, distance, index)) return;
    if (occluded(Ray(way.near, back / reach, index, false), reach, index)) return;
    record_link(self.emission, rho, weight);
    splat(place, value, layer_of(self, self.path.depth + 2 + chords));
}

// Links a particle to the camera at a surface that is not smooth. `by_spheres`: also through one of the linked spheres.
void link_to_camera(Particle self, Meeting at, bool by_spheres, inout Sampler rng) {
    Eye eye = sample_eye(rng);
    link_straight(self, at, eye);
    // A loop, because llvmpipe runs the body of an `if` in any case, but leaves out a loop that no lane enters.
    int tries = LINKED != 0 && by_spheres ? 1 : 0;
    for (int i = 0; i < tries; ++i) link_through_sphere(self, at, eye, rng);
}
