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

// The radiance of the light in the direction in which the particle left it.
vec3 radiance_of(Particle self) {
    vec3 radiance = self.power * (self.emission / PI);
    return radiance;
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
    record_link(radiance_of(self), frame.particles * self.emission, pdf, weight);
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

// A way to the eye through one sphere.
struct Through {
    int sphere;      // NO_SHAPE: there is no way
    Material material;
    Arc arc;
    Crossing at;
    Way way;
    vec3 direction;  // unit, from the point that is linked
    float distance;  // from there to the sphere
    vec2 place;      // on the film
};

// The sphere and the numbers that draw a way.
struct Draw {
    int sphere;
    Material material;
    int chords;
    float by_branch;
};

Draw draw_sphere(inout Sampler rng) {
    vec2 pick = next_2d(rng);
    float by_branch = next_1d(rng);
    int count = bitCount(LINKED);
    int index = sphere_of(LINKED, min(int(pick.x * float(count)), count - 1));
    Material material = material_at(sphere_at(index).material);
    return Draw(index, material, draw_chords(material, pick.y), by_branch);
}

// Finds the way along an arc, without direction and distance. `events`: how often a path is scattered from the lamp to
// the point that is linked, and there.
Through find_link(Draw drawn, Arc arc, int events, Eye eye) {
    Way nowhere = Way(vec3(0.0), vec3(0.0), vec3(0.0));
    Crossing never = Crossing(vec3(0.0), 0.0, 0.0, 0.0);
    Through link = Through(NO_SHAPE, drawn.material, arc, never, nowhere, vec3(0.0), 0.0, vec2(0.0));
    if (events + 1 + drawn.chords > frame.bounces || !has_links(arc)) return link;
    Branch branch = draw_branch(arc, drawn.by_branch);
    float half_tangent = meeting_of(arc, branch);
    if (half_tangent < 0.0) return link;
    link.at = crossing_of(arc, incidence_of(half_tangent).sine);
    link.way = way_of(arc, sphere_at(drawn.sphere).center, link.at, sense_of(branch, drawn.chords));
    link.place = place_on_film(link.way.direction, eye.lens);
    if (dot(link.way.direction, frame.camera.forward) > 0.0 && is_on_film(link.place)) link.sphere = drawn.sphere;
    return link;
}

// Draws a way from a point to the eye at random; see find_link.
Through draw_link(vec3 from, int events, Eye eye, inout Sampler rng) {
    Draw drawn = draw_sphere(rng);
    Arc arc = arc_of(eye.position, from, sphere_at(drawn.sphere), drawn.material.ior, drawn.chords);
    Through link = find_link(drawn, arc, events, eye);
    vec3 away = link.way.far - from;
    link.distance = length(away);
    link.direction = away / link.distance;
    return link;
}

// `rho_of_way` of such a way; 0: no link. `cosine`: at the normal of the point that is linked.
float rho_of_drawn(Through link, float cosine) {
    return rho_of_way(pdf_camera(link.way.direction), link.material, link.arc, link.at, cosine);
}

// Whether something hides the eye along the way; `ray` goes from the point to the sphere, over `distance`.
bool is_hidden(Through link, Ray ray, float distance, Eye eye) {
    if (occluded(ray, distance, link.sphere)) return true;
    vec3 back = eye.position - link.way.near;
    float reach = length(back);
    return occluded(Ray(link.way.near, back / reach, link.sphere, false), reach, link.sphere);
}

// Links a particle to the eye through one sphere, by one way drawn at random, and adds the light.
void link_through_sphere(Particle self, Meeting from, Eye eye, inout Sampler rng) {
    Ray ray = from.ray;
    Through link = draw_link(ray.origin, self.path.depth + 1, eye, rng);
    if (link.sphere == NO_SHAPE) return;
    ray.direction = link.direction;
    vec3 wi = to_local(from.vertex.frame, ray.direction);
    if (!leaves_so(from.vertex, wi, ray)) return;
    float rho = rho_of_drawn(link, abs(wi.z));
    if (rho == 0.0) return;  // with an infinite kappa the weight would be 0
    Turn turn = turn_of_link(from.vertex, from.normals, -self.path.ray.direction, ray.direction);
    if (turn.turn == 0.0) return;
    float weight = weight_of_link(self, rho / self.emission, turn.turn);
    float distance = link.distance + length(eye.position - link.way.near);
    vec3 flux = self.power * self.path.throughput * tint_of(link.material, link.arc, link.at);
    if (HAS_ATTENUATION) flux *= share_left(wi.z < 0.0 ? from.behind : self.path.absorption, distance);
    vec3 value = flux * turn.value * (frame.particles * rho * weight);
    if (value == vec3(0.0) || is_hidden(link, ray, link.distance, eye)) return;
    record_link(radiance_of(self), self.emission, rho, weight);
    splat(link.place, value, layer_of(self, self.path.depth + 2 + link.arc.chords));
}

// Links a particle to the camera at a surface that is not smooth. `by_spheres`: also through one of the linked spheres.
void link_to_camera(Particle self, Meeting at, bool by_spheres, inout Sampler rng) {
    Eye eye = sample_eye(rng);
    link_straight(self, at, eye);
    // A loop, because llvmpipe runs the body of an `if` in any case, but leaves out a loop that no lane enters.
    int tries = LINKED != 0 && by_spheres ? 1 : 0;
    for (int i = 0; i < tries; ++i) link_through_sphere(self, at, eye, rng);
}
