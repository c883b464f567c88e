// A thin pane of glass: both faces at once, with the reflections between them. Light that
// passes goes straight on.

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
