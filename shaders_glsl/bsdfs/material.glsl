// The choice of a BSDF by the kind of a material. Each kind is named in sample_material and, unless it
// is a delta, in eval_material and pdf_material; MATTE is what remains.

bool is_delta(Material material) {
    if (HAS_DIELECTRIC && material.kind == DIELECTRIC) return true;
    return HAS_MIRROR && material.kind == METAL && material.alpha == 0.0;
}

vec3 eval_material(Vertex vertex, vec3 wi) {
    precise Material material = vertex.material;
    if (HAS_ROUGH_METAL && material.kind == METAL) return eval_metal(vertex, wi);
    return eval_matte(material.color, wi);
}

float pdf_material(Vertex vertex, vec3 wi) {
    if (HAS_ROUGH_METAL && vertex.material.kind == METAL) return pdf_metal(vertex, wi);
    return pdf_matte(wi);
}

// `outside`: whether wo is on the outer side of the surface.
Scattering sample_material(Vertex vertex, bool outside, precise inout Sampler rng) {
    precise Material material = vertex.material;
    if (HAS_DIELECTRIC && material.kind == DIELECTRIC) {
        precise float eta = outside ? 1.0 / material.ior : material.ior;
        precise float u = next_1d(rng);
        return sample_dielectric(vertex, eta, u);
    }
    precise vec2 u = next_2d(rng);
    if ((HAS_MIRROR || HAS_ROUGH_METAL) && material.kind == METAL) return sample_metal(vertex, u);
    return sample_matte(vertex, u);
}
