// What a path from the camera keeps of particles that carry the same light: rho of particle_weights.glsl.

// Whether particles are linked to the camera at a vertex: the first that is not smooth, straight or by the path's chain.
bool links_at(Path path, Vertex vertex) {
    bool is_first = path.depth == 0 || LINKED != 0 && path.chain.state != BROKEN;
    return HAS_PARTICLES && is_first && !is_delta(vertex.material);
}

// What particles that are linked to the camera at the path's first vertex are weighed against: none are, or
// come so far, at a surface that they do not scatter at. `facing`: the true normal on the side of wo.
float rho_beyond(Path path, Vertex vertex, Surface surface, vec3 facing) {
    if (!carries_particles(vertex.material)) return 0.0;
    if (!links_at(path, vertex)) return path.rho;
    precise float cosine = HAS_SHADING ? -dot(path.ray.direction, facing) : vertex.wo.z;
    if (path.depth > 0) return rho_of_link(path.chain, surface.position, cosine);
    precise float distance = length(surface.position - path.ray.origin);
    precise float rho = pdf_film(path.ray.direction, cosine, distance) / frame.particles;
    return rho;
}

// P0 over PL of a path that scatters at a vertex to wi. `normals`: on the side of wo; `is_linked`: whether particles are
// linked to the camera here.
float path_turn(Path path, Vertex vertex, Normals normals, vec3 wi, bool is_linked) {
    if (is_glossy(vertex.material)) return glossy_turn(vertex, normals, wi, is_linked);
    return turn_around(vertex.frame[2], normals.facing, wi, -path.ray.direction, is_delta(vertex.material));
}
