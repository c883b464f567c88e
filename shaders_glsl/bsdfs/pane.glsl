// A thin pane of glass: both faces at once, with the reflections between them. Light that
// passes a smooth pane goes straight on.

// Reflectance of a pane whose single face has F: F + F (1 - F)^2 + F^3 (1 - F)^2 + ... = 2 F / (1 + F).
float pane_reflectance(float cosine, float ior) {
    float face = fresnel(cosine, 1.0 / ior);
    float reflectance = 2.0 * face / (1.0 + face);
    return reflectance;
}

Scattering sample_pane(Vertex vertex, float u) {
    vec3 incoming = -(vertex.frame * vertex.wo);
    bool reflects = u < pane_reflectance(vertex.wo.z, vertex.material.ior);
    if (reflects) incoming += 2.0 * vertex.wo.z * vertex.frame[2];
    vec3 direction = normalized(incoming);
    vec3 weight = reflects ? vec3(1.0) : crossing_tint(vertex.material);
    return Scattering(direction, weight, 0.0, 1.0, !reflects);
}

// Facets of a rough pane, each a pane. Light that passes one leaves in the direction of the light that it reflects,
// mirrored to the other side of the pane (KHR_materials_transmission of glTF).

// The half vector with wi, or with its mirror image where wi is on the other side.
vec3 pane_half(Vertex vertex, vec3 wi) {
    vec3 h = normalized(vertex.wo + vec3(wi.xy, abs(wi.z)));
    return h;
}

Lobe pane_facet_lobe(Vertex vertex, vec3 h, vec3 wi) {
    Material material = vertex.material;
    float reflected = pane_reflectance(dot(vertex.wo, h), material.ior);
    float share = wi.z < 0.0 ? 1.0 - reflected : reflected;
    float pdf = share * pdf_ggx(material.alpha, vertex.wo, h);
    float value = pdf * ggx_weight(material.alpha, vertex.wo, vec3(wi.xy, abs(wi.z)));
    return Lobe(value, pdf);
}

// The direction to which a facet reflects or lets through; 0 if it reflects below the surface.
vec3 beyond_pane_facet(Vertex vertex, vec3 h, float u) {
    float cosine = dot(vertex.wo, h);
    vec3 wi = 2.0 * cosine * h - vertex.wo;
    if (wi.z <= 0.0) return vec3(0.0);
    if (u >= pane_reflectance(cosine, vertex.material.ior)) wi.z = -wi.z;
    return wi;
}
