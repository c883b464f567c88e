// State of a path from the camera for particles that carry the same light: rho of particle_weights.glsl.

// Whether particles are linked to the camera at a vertex. This is the first vertex that is not smooth; the link is
// straight, or goes through the sphere of the path's chain.
bool links_at(Path path, Vertex vertex) {
    bool is_first = path.depth == 0 || LINKED != 0 && path.rivals.chain.state != BROKEN;
    return HAS_PARTICLES && is_first && !is_delta(vertex.material);
}

// rho of the path beyond a surface. It is 0 where no particles are linked to the camera at the path's first vertex.
float rho_beyond(Path path, Meeting at) {
    if (!HAS_PARTICLES) return path.rivals.rho;
    if (!links_at(path, at.vertex)) return path.rivals.rho;
    float cosine = HAS_SHADING ? -dot(path.ray.direction, at.normals.facing) : at.vertex.wo.z;
    if (path.depth > 0) return rho_of_link(path.rivals.chain, at.ray.origin, cosine);
    float distance = length(at.ray.origin - path.ray.origin);
    float rho = pdf_film(path.ray.direction, cosine, distance) / frame.particles;
    return rho;
}

// P0 over PL of a path that scatters at a surface to wi, with the density `pdf`. `is_linked`: whether particles are
// linked to the camera there.
float path_turn(Path path, Meeting at, vec3 wi, float pdf, bool is_linked) {
    if (!HAS_PARTICLES) return 1.0;
    if (is_mirrored(at.vertex, pdf)) return is_linked ? 0.0 : mirrored_turn(at.normals, wi, -path.ray.direction);
    if (is_glossy(at.vertex.material)) return glossy_turn(at.vertex, at.normals, wi, is_linked);
    bool is_smooth = is_delta(at.vertex.material);
    return turn_around(at.vertex.frame[2], at.normals.facing, wi, -path.ray.direction, is_smooth);
}

// Whether the path sees a light, if its next segment meets one: straight, or through one sphere.
bool sees_lights(Path path) {
    return LINKS_LIGHTS && (path.depth == 0 || LINKED != 0 && path.rivals.chain.state == LINKING);
}

// Weight of light that such a segment meets. `rho`: of the path; `density`: of the particles that begin there.
float weight_of_seen(float rho, float density) {
    if (density == 0.0 || rho == 0.0) return 1.0;  // no particle is linked along this path
    float weight = weight_beside_links(rho / density);
    record_weight(density, weight);
    return weight;
}

// The same of a lamp.
float weight_of_seen_lamp(Path path, Surface surface) {
    vec3 direction = path.ray.direction;
    float density = density_on_lamp(surface.light, surface.position, -direction);
    float cosine = abs(dot(direction, true_normal(surface)));
    float rho = 0.0;
    if (path.depth > 0) rho = rho_of_link(path.rivals.chain, surface.position, cosine);
    else rho = pdf_film(direction, cosine, length(surface.position - path.ray.origin)) / frame.particles;
    float weight = weight_of_seen(rho, density);
    return weight;
}

// The same of the sun or the sky, where a segment leaves the scene.
float weight_of_seen_afar(Path path, int light) {
    vec3 direction = path.ray.direction;
    float rho = path.depth > 0 ? rho_of_afar(path.rivals.chain, direction) : pdf_camera(direction) / frame.particles;
    float weight = weight_of_seen(rho, density_of_afar(light, direction));
    return weight;
}
