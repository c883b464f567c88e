// Rough glass. An interface between two dielectrics has GGX facets that reflect and refract (Walter et al., "Microfacet Models
// for Refraction through Rough Surfaces", EGSR 2007). They are sampled by visible normals, and
// G2 = 1 / (1 + L(wo) + L(wi)) for both. Light that facets lose to each other comes back as one lobe on each side:
// a share of (1 - E(wo)) (1 - E(wi)) cos wi / (PI (1 - mean E)), where E is the directional albedo of the facets
// (Kulla and Conty, "Revisiting Physically Based Shading at Imageworks", 2017). So the whole is reciprocal.
// Values here are of energy: radiance that crosses also scales by eta^2.
// Rough panes have facets of their own (pane.glsl), and get the light back that these lose.

const float SMOOTHEST = 1e-8;  // facets that spread refracted light by a smaller angle are smooth

bool is_rough_glass(Material material) {
    if (HAS_ROUGH_PANE && material.kind == PANE) return material.alpha > 0.0;
    return HAS_ROUGH_GLASS && material.kind == DIELECTRIC && material.alpha > 0.0;
}

// Whether rough glass is a pane.
bool has_pane_facets(Material material) {
    return HAS_ROUGH_PANE && (!HAS_ROUGH_GLASS || material.kind == PANE);
}

bool has_lost_light(Glass glass) {
    return glass.first_albedo >= 0;
}

// Directional albedo of the facets; `outside`: whether light comes from outside.
float facet_albedo(Glass glass, bool outside, float cosine) {
    vec2 both = albedos(glass.first_albedo, cosine);
    return outside ? both.x : both.y;
}

// Value and density of facets with the normal h, which is on the side of wo.
Lobe facet_lobe(Vertex vertex, vec3 h, vec3 wi) {
    if (has_pane_facets(vertex.material)) return pane_facet_lobe(vertex, h, wi);
    float alpha = vertex.material.alpha;
    float cos_o = dot(vertex.wo, h);
    float cos_i = dot(wi, h);
    bool crosses = wi.z < 0.0;
    if (cos_o <= 0.0 || (cos_i < 0.0) != crosses) return Lobe(0.0, 0.0);
    float reflected = fresnel(cos_o, vertex.eta);
    float pdf = pdf_ggx(alpha, vertex.wo, h);
    if (crosses) {
        float stretch = vertex.eta * cos_o + cos_i;
        pdf *= (1.0 - reflected) * (4.0 * cos_o / stretch) * (-cos_i / stretch);
    } else {
        pdf *= reflected;
    }
    float weight = ggx_weight(alpha, vertex.wo, vec3(wi.xy, abs(wi.z)));
    float value = pdf * weight;
    return Lobe(value, pdf);
}

// The normal of facets that send wi to wo.
vec3 glass_half(Vertex vertex, vec3 wi) {
    if (has_pane_facets(vertex.material)) return pane_half(vertex, wi);
    float eta = wi.z < 0.0 ? vertex.eta : 1.0;
    vec3 h = normalized(eta * vertex.wo + wi);
    if (h.z < 0.0) h = -h;
    return h;
}

// Value and density of facets together with the light that they lose. Samples take facets with a probability equal to
// the share of light that these keep.
Lobe glass_lobe(Vertex vertex, vec3 h, vec3 wi) {
    Lobe facets = facet_lobe(vertex, h, wi);
    Glass glass = glass_at(vertex.material.details);
    if (!has_lost_light(glass)) return facets;
    bool crosses = wi.z < 0.0;
    bool arrives_outside = vertex.is_outside != crosses;
    float kept = facet_albedo(glass, vertex.is_outside, vertex.wo.z);
    float crossing = vertex.is_outside ? glass.crossing_outer : glass.crossing_inner;
    float lost = (1.0 - kept) * (crosses ? crossing : 1.0 - crossing) * (abs(wi.z) / PI);
    float mean_lost = arrives_outside ? glass.mean_outer : glass.mean_inner;
    float again = (1.0 - facet_albedo(glass, arrives_outside, abs(wi.z))) / mean_lost;
    float value = facets.value + lost * again;
    float pdf = kept * facets.pdf + lost;
    return Lobe(value, pdf);
}

float glass_scale(Vertex vertex, vec3 wi) {
    if (has_pane_facets(vertex.material)) return 1.0;
    float scale = wi.z < 0.0 ? vertex.eta * vertex.eta : 1.0;
    return scale;
}

vec3 eval_rough_dielectric(Vertex vertex, vec3 wi) {
    Lobe lobe = glass_lobe(vertex, glass_half(vertex, wi), wi);
    vec3 value = vec3(lobe.value * glass_scale(vertex, wi));
    if (wi.z < 0.0) value *= crossing_tint(vertex.material);
    return value;
}

float pdf_rough_dielectric(Vertex vertex, vec3 wi) {
    return glass_lobe(vertex, glass_half(vertex, wi), wi).pdf;
}

// The direction to which a facet with the normal h reflects or refracts; 0 if to the wrong side.
vec3 beyond_facet(Vertex vertex, vec3 h, float u) {
    if (has_pane_facets(vertex.material)) return beyond_pane_facet(vertex, h, u);
    float cos_o = dot(vertex.wo, h);
    bool crosses = u >= fresnel(cos_o, vertex.eta);
    float cos_t = sqrt(max(refracted_cos2(cos_o, vertex.eta), 0.0));
    vec3 reflected = 2.0 * cos_o * h - vertex.wo;
    vec3 refracted = (vertex.eta * cos_o - cos_t) * h - vertex.eta * vertex.wo;
    vec3 wi = crosses ? refracted : reflected;
    bool is_right = crosses ? wi.z < 0.0 : wi.z > 0.0;
    return is_right ? wi : vec3(0.0);
}

Scattering sample_rough_dielectric(Vertex vertex, float choice, vec2 u) {
    Glass glass = glass_at(vertex.material.details);
    float kept = 1.0;
    if (has_lost_light(glass)) kept = facet_albedo(glass, vertex.is_outside, vertex.wo.z);
    vec3 h = sample_ggx_normal(vertex.material.alpha, vertex.wo, u);
    vec3 wi = beyond_facet(vertex, h, choice / kept);
    if (choice >= kept) {
        float crossing = vertex.is_outside ? glass.crossing_outer : glass.crossing_inner;
        wi = sample_cosine_hemisphere(u);
        if (choice - kept < crossing * (1.0 - kept)) wi.z = -wi.z;
        h = glass_half(vertex, wi);
    }
    if (wi.z == 0.0) return absorbed();
    Lobe lobe = glass_lobe(vertex, h, wi);
    if (lobe.pdf == 0.0) return absorbed();
    vec3 direction = normalized(vertex.frame * wi);
    vec3 weight = vec3(lobe.value / lobe.pdf);
    if (wi.z < 0.0) weight *= crossing_tint(vertex.material);
    return Scattering(direction, weight, lobe.pdf, glass_scale(vertex, wi), wi.z < 0.0);
}
