// What is known of a path on its way.

struct Path {
    Ray ray;          // its next segment
    vec3 throughput;
    float scale;      // of radiance by refraction, which roulette ignores
    vec3 radiance;    // gathered so far
    float pdf;        // of the last scattering; 0 if it was a delta, or none yet
    float lamps;      // weight of all that are sampled, where it scattered last
    int depth;        // scattering events so far
    vec3 absorption;  // of the glass that its next segment lies in
    uint counts;      // of the glasses with a priority there
    uint holes;       // that this segment has passed
    Ray start;        // it, where it left the vertex, if it has
    float way;        // from there to the last hole
    float rho;        // what particles are weighed against (integrators/particle_weights.glsl); 0: they do not come
    Chain chain;      // of what it met first
    bool asks_probes; // whether the next matte surface does
    bool is_last;     // whether its next segment is its last, for light beyond it is that of probes
    vec3 layers[MOST_LAYERS];  // the radiance by layers
};

Path start_path(Ray ray) {
    precise vec3 absorption = HAS_ATTENUATION ? frame.camera_absorption : vec3(0.0);
    uint counts = HAS_NESTED ? frame.camera_counts : 0u;
    bool asks_probes = !FINAL_GATHER || FROM_PROBES;
    return Path(ray, vec3(1.0), 1.0, vec3(0.0), 0.0, 0.0, 0, absorption, counts, 0u, ray, 0.0, 0.0, start_chain(ray),
                asks_probes, false, NO_LAYERS);
}

// Light of a lamp that is `length` scattering events from the camera; `group` is its layer. What a probe sees shine
// is direct light of what it lights, which paths find.
void gather(precise inout Path path, vec3 light, int group, int length) {
    if (FROM_PROBES && length == 0) return;
    path.radiance += light;
    if (LAYERS > 0) add_to_layer(path.layers, light, BY_LENGTH ? length : group);
}
