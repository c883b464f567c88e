// State of a path on its way: the data of every path, and the data that single features add.

// The holes that the present segment has passed.
struct Passed {
    uint holes;
    Ray start;  // the segment, where it left the vertex
    float way;  // distance from there to the last hole
};

// Particles that carry the same light as the path (integrators/particle_weights.glsl).
struct Rivals {
    float rho;    // particles are weighed against it; 0: no particles come
    Chain chain;  // smooth spheres that the path met first
};

// Probes, which replace the rest of the path.
struct Asking {
    bool is_due;   // whether the next matte surface asks probes
    bool is_done;  // whether probes were asked, or the rest is left out: the next segment is the last
    bool is_open;  // whether the background has lit the last surface already
};

struct Path {
    Ray ray;          // its next segment
    vec3 throughput;
    float scale;      // scale of radiance by refraction, which roulette ignores
    vec3 radiance;    // gathered so far
    float pdf;        // density of the last scattering; 0 if it was a delta, or none yet
    float lamps;      // total weight of all lamps that are sampled, where the path scattered last
    int depth;        // scattering events so far
    vec3 absorption;  // of the glass that its next segment lies in
    uint counts;      // counts of the glasses with a priority there, or the volumes where HAS_RANKS
    Passed passed;
    Rivals rivals;
    Asking asking;
    Flight flight;
    Approach approach;
    vec3 layers[MOST_LAYERS];  // the radiance by layers
    Terms terms;               // and by terms
};

Path start_path(Ray ray) {
    vec3 absorption = HAS_ATTENUATION ? frame.camera_absorption : vec3(0.0);
    uint counts = HAS_NESTED || HAS_RANKS ? frame.camera_counts : 0u;
    Passed passed = Passed(0u, ray, 0.0);
    Rivals rivals = Rivals(0.0, start_chain(ray));
    Flight flight = start_flight(HAS_MEDIA ? frame.camera_medium : NO_MEDIUM);
    Asking asking = Asking(!FINAL_GATHER || FROM_PROBES, false, false);
    return Path(ray, vec3(1.0), 1.0, vec3(0.0), 0.0, 0.0, 0, absorption, counts, passed, rivals, asking, flight,
                no_approach(), NO_LAYERS, no_terms());
}

// Adds light of a lamp that is `length` scattering events from the camera; `group` is its layer. A path of a probe
// leaves out emission that the probe itself sees: for a surface that the probe lights, this is direct light, which
// paths find.
void gather(inout Path path, vec3 light, int group, int length) {
    if (FROM_PROBES && length == 0) return;
    path.radiance += light;
    if (LAYERS > 0) add_to_layer(path.layers, light, BY_LENGTH ? length : group);
    if (LIGHT_TERMS != 0) sort_light(path.terms, light, length);
}

// Sorts light that this vertex scatters from a direction of the world into terms, where it is the first vertex.
// `pdf` 0: by a delta.
void sort_by_surface(inout Path path, Vertex vertex, vec3 direction, float pdf, bool crosses) {
    if (path.depth > 0) return;
    bool is_mirrored = pdf == 0.0 && vertex.material.kind != MATTE;
    path.terms.base = is_mirrored ? vec3(0.0) : base_share(vertex, to_local(vertex.frame, direction));
    path.terms.rest = crosses ? TRANSMISSION : GLOSSY;
}

// The same for light of a classic model: of its ambient light, or of a lamp in a direction of the world.
void sort_ambient(inout Path path) {
    path.terms.base = vec3(1.0);
    path.terms.rest = GLOSSY;
}

void sort_point_light(inout Path path, Vertex vertex, vec3 direction) {
    sort_by_surface(path, vertex, direction, 1.0, false);
    if (OWN_PHONG) path.terms.base = phong_base_share(vertex, to_local(vertex.frame, direction));
}

// The same for light that a medium scatters.
void sort_by_medium(inout Path path) {
    if (path.depth > 0) return;
    path.terms.base = vec3(0.0);
    path.terms.rest = VOLUME;
}
