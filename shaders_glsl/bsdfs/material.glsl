// The choice of a BSDF by the kind of a material. Each kind is named in sample_material and, unless it
// is a delta, in eval_material and pdf_material; MATTE is the remaining kind. Light passes NONE before a BSDF is chosen.

bool is_delta(Material material) {
    if (HAS_DIELECTRIC && material.kind == DIELECTRIC) return !is_rough_glass(material);
    if (HAS_PANE && material.kind == PANE) return !is_rough_glass(material);
    return HAS_MIRROR && material.kind == METAL && material.alpha == 0.0;
}

vec3 eval_material(Vertex vertex, vec3 wi) {
    Material material = vertex.material;
    if (HAS_ROUGH_METAL && material.kind == METAL) return eval_metal(vertex, wi);
    if (HAS_ROUGH_GLASS && material.kind == DIELECTRIC) return eval_rough_dielectric(vertex, wi);
    if (HAS_ROUGH_PANE && material.kind == PANE) return eval_rough_dielectric(vertex, wi);
    if (HAS_PRINCIPLED && material.kind == PRINCIPLED) return eval_principled(vertex, wi);
    return eval_matte(material.color, wi);
}

float pdf_material(Vertex vertex, vec3 wi) {
    if (HAS_ROUGH_METAL && vertex.material.kind == METAL) return pdf_metal(vertex, wi);
    if (HAS_ROUGH_GLASS && vertex.material.kind == DIELECTRIC) return pdf_rough_dielectric(vertex, wi);
    if (HAS_ROUGH_PANE && vertex.material.kind == PANE) return pdf_rough_dielectric(vertex, wi);
    if (HAS_PRINCIPLED && vertex.material.kind == PRINCIPLED) return pdf_principled(vertex, wi);
    return pdf_matte(wi);
}

Scattering sample_material(Vertex vertex, inout Sampler rng) {
    Material material = vertex.material;
    if (HAS_DIELECTRIC && material.kind == DIELECTRIC) {
        float choice = next_1d(rng);
        if (HAS_DISPERSION && disperses(material)) return sample_dispersing(vertex, choice);
        if (!is_rough_glass(material)) return sample_dielectric(vertex, choice);
        vec2 u = next_2d(rng);
        return sample_rough_dielectric(vertex, choice, u);
    }
    if (HAS_PANE && material.kind == PANE) {
        float choice = next_1d(rng);
        if (!is_rough_glass(material)) return sample_pane(vertex, choice);
        vec2 u = next_2d(rng);
        return sample_rough_dielectric(vertex, choice, u);
    }
    if (HAS_PRINCIPLED && material.kind == PRINCIPLED) {
        float choice = next_1d(rng);
        vec2 u = next_2d(rng);
        return sample_principled(vertex, choice, u);
    }
    vec2 u = next_2d(rng);
    if ((HAS_MIRROR || HAS_ROUGH_METAL) && material.kind == METAL) return sample_metal(vertex, u);
    return sample_matte(vertex, u);
}

// The share of a matte base in light that is scattered from wi.
vec3 base_share(Vertex vertex, vec3 wi) {
    if (vertex.material.kind == MATTE) return vec3(1.0);
    if (HAS_PRINCIPLED && vertex.material.kind == PRINCIPLED) return base_share_of_principled(vertex, wi);
    return vec3(0.0);
}
