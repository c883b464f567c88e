// Lobes of principled surfaces: their values, densities and samples.

// Value and density of all parts that are not deltas; h: half vector.
ColorLobe principled_lobe(Principled it, Vertex vertex, vec3 wi, vec3 h) {
    Gloss gloss = it.gloss;
    Shares from = shares_of(vertex, gloss, wi);
    Shares to = shares_of(vertex, gloss, vertex.wo);
    vec4 chances = lobe_chances(it, vertex.wo.z, to);
    float even = wi.z / PI;
    float pdf = chances.z * even;
    if (HAS_TRANSLUCENCY) pdf *= 1.0 - crossing_chance(it, to);
    vec3 value = it.again * (from.lost * to.lost * gloss.spread);
    value += it.base * (from.base * to.base * gloss.even_base);
    value *= even;
    float alpha = vertex.material.alpha;
    float along = dot(vertex.wo, h);
    float edge = schlick_weight(along);
    if (alpha > 0.0) {
        float density = pdf_facets(vertex, h);
        vec3 reflectance = facet_reflectance(it, vertex.material, along, edge);
        value += reflectance * (density * facets_weight(vertex, wi));
        pdf += chances.y * density;
    }
    if (HAS_SHEEN && has_sheen(gloss)) {
        Sheen sheen = sheen_of(gloss);
        value *= min(below_sheen(gloss, wi.z), below_sheen(gloss, vertex.wo.z));
        pdf += chances.w / (2.0 * PI);
        value += sheen.color * eval_white_sheen(sheen, vertex.wo, wi, h);
    }
    if (!HAS_COAT || gloss.coat == 0.0) return ColorLobe(value, pdf);
    value *= min(below_coat(gloss, wi.z), below_coat(gloss, vertex.wo.z));
    if (gloss.coat_alpha > 0.0) {
        float density = pdf_ggx(gloss.coat_alpha, vertex.wo, h);
        float reflected = gloss.coat * (COAT_F0 + (1.0 - COAT_F0) * edge);
        value += reflected * (density * ggx_weight(gloss.coat_alpha, vertex.wo, wi));
        pdf += chances.x * density;
    }
    return ColorLobe(value, pdf);
}

vec3 eval_principled(Vertex vertex, vec3 wi) {
    Principled it = principled_of(vertex.material);
    if (HAS_TRANSLUCENCY && wi.z < 0.0) return crossing_lobe(it, vertex, wi).value;
    vec3 h = normalized(vertex.wo + wi);
    return principled_lobe(it, vertex, wi, h).value;
}

float pdf_principled(Vertex vertex, vec3 wi) {
    Principled it = principled_of(vertex.material);
    if (HAS_TRANSLUCENCY && wi.z < 0.0) return crossing_lobe(it, vertex, wi).pdf;
    vec3 h = normalized(vertex.wo + wi);
    return principled_lobe(it, vertex, wi, h).pdf;
}

// The share of the base in light that is scattered from wi; 0 where none is, or where light crosses the surface.
vec3 base_share_of_principled(Vertex vertex, vec3 wi) {
    if (HAS_TRANSLUCENCY && wi.z < 0.0) return vec3(0.0);
    Principled it = principled_of(vertex.material);
    vec3 h = normalized(vertex.wo + wi);
    vec3 whole = principled_lobe(it, vertex, wi, h).value;
    it.base = vec3(0.0);
    vec3 base = whole - principled_lobe(it, vertex, wi, h).value;
    vec3 share = vec3(0.0);
    for (int i = 0; i < 3; i += 1) {
        if (whole[i] > 0.0) share[i] = base[i] / whole[i];
    }
    return share;
}

Scattering sample_principled(Vertex vertex, float choice, vec2 u) {
    Principled it = principled_of(vertex.material);
    Gloss gloss = it.gloss;
    float cosine = vertex.wo.z;
    vec4 chances = lobe_chances(it, cosine, shares_of(vertex, gloss, vertex.wo));
    bool is_coat = HAS_COAT && choice < chances.x;
    vec3 h = vec3(0.0, 0.0, 1.0);
    vec3 wi = vec3(-vertex.wo.xy, cosine);
    if (is_coat || choice < chances.x + chances.y) {
        float alpha = is_coat ? gloss.coat_alpha : vertex.material.alpha;
        if (alpha == 0.0) {
            float edge = schlick_weight(cosine);
            vec3 reflectance = facet_reflectance(it, vertex.material, cosine, edge);
            vec3 weight = reflectance * below_coat(gloss, cosine) / chances.y;
            if (HAS_SHEEN) weight *= below_sheen(gloss, cosine);
            if (is_coat) weight = vec3(gloss.coat * (COAT_F0 + (1.0 - COAT_F0) * edge) / chances.x);
            vec3 mirrored = normalized(vertex.frame * wi);
            return Scattering(mirrored, weight, 0.0, 1.0, false);
        }
        h = sample_ggx_normal(alpha, is_coat ? vertex.wo : stretched(vertex, vertex.wo), u);
        if (HAS_ANISOTROPY && !is_coat) h = normalized(stretched(vertex, h));
        wi = 2.0 * dot(vertex.wo, h) * h - vertex.wo;
    } else {
        bool is_sheen = HAS_SHEEN && choice < chances.x + chances.y + chances.w;
        wi = is_sheen ? sample_cone(1.0, u) : sample_cosine_hemisphere(u);
        if (HAS_TRANSLUCENCY && !is_sheen) {
            float rest = (choice - (1.0 - chances.z)) / chances.z;
            if (rest < crossing_chance(it, shares_of(vertex, gloss, vertex.wo))) return sample_across(it, vertex, wi);
        }
        h = normalized(vertex.wo + wi);
    }
    if (wi.z <= 0.0) return absorbed();
    ColorLobe lobe = principled_lobe(it, vertex, wi, h);
    if (lobe.pdf == 0.0) return absorbed();
    vec3 direction = normalized(vertex.frame * wi);
    vec3 weight = lobe.value / lobe.pdf;
    return Scattering(direction, weight, lobe.pdf, 1.0, false);
}
