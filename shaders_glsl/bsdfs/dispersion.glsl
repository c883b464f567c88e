// Smooth glass whose index of refraction depends on the wavelength. Red, green and blue have the indices of the
// Fraunhofer lines C (656.3 nm), d (587.6 nm) and F (486.1 nm), by Cauchy's formula with two terms. The row of the
// material has the index at d as `ior`, and the difference between F and C as `metallic`.

// The indices of the lines minus that of d, over the difference between F and C. The formula is that of
// KHR_materials_dispersion, n(l) = n_d + (523655 nm^2 / l^2 - 1.5168) (n_d - 1) / V.
const vec3 OFF_THE_D_LINE = vec3(-0.30104, 0.0, 0.69936);

bool disperses(Material material) {
    return material.kind == DIELECTRIC && material.metallic > 0.0;
}

// Eta of each channel in which the path has light, 0 of the others.
vec3 etas_of(Vertex vertex, vec3 throughput) {
    vec3 iors = max(vertex.material.ior + vertex.material.metallic * OFF_THE_D_LINE, 1.0);
    vec3 etas = vertex.is_outside ? 1.0 / iors : iors;
    etas *= vec3(greaterThan(throughput, vec3(0.0)));
    return etas;
}

// The channel that a number of 0 to `count` - 1 chooses among those with light.
int channel_among(vec3 is_lit, int number) {
    int left = number;
    for (int channel = 0; channel < 2; channel++) {
        if (is_lit[channel] == 0.0) continue;
        if (left == 0) return channel;
        left -= 1;
    }
    return 2;
}

// Chooses a channel, then reflection or refraction by its Fresnel reflectance. All channels reflect to the same
// direction, so a reflected path keeps all of them, weighed by their reflectance over the mean. A refracted path keeps
// the chosen channel.
Scattering sample_dispersing(Vertex vertex, float u) {
    vec3 is_lit = vec3(greaterThan(vertex.etas, vec3(0.0)));
    float count = dot(is_lit, vec3(1.0));
    if (count == 0.0) return absorbed();
    float scaled = u * count;
    float number = min(floor(scaled), count - 1.0);
    int channel = channel_among(is_lit, int(number));
    float cos_i = vertex.wo.z;
    vec3 etas = vertex.etas;
    vec3 reflectance = is_lit * vec3(fresnel(cos_i, etas.r), fresnel(cos_i, etas.g), fresnel(cos_i, etas.b));
    Vertex own = vertex;
    own.eta = etas[channel];
    bool reflects = scaled - number < reflectance[channel];
    Scattering next = sample_dielectric(own, reflects ? -1.0 : 1.0);
    if (reflects) {
        float mean = dot(reflectance, vec3(1.0)) / count;
        next.weight = reflectance / mean;
    } else {
        vec3 chosen = vec3(equal(ivec3(channel), ivec3(0, 1, 2)));
        next.weight *= count * chosen;
    }
    return next;
}
