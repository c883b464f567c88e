// Mirrors, and rough metal.

vec3 eval_metal(Vertex vertex, vec3 wi) {
    Material material = vertex.material;
    vec3 h = normalized(vertex.wo + wi);
    float density = pdf_facets(vertex, h);
    float weight = facets_weight(vertex, wi);
    vec3 reflectance = metal_reflectance(material, dot(vertex.wo, h));
    vec3 value = reflectance * (density * weight);
    return value;
}

float pdf_metal(Vertex vertex, vec3 wi) {
    vec3 h = normalized(vertex.wo + wi);
    return pdf_facets(vertex, h);
}

Scattering sample_metal(Vertex vertex, vec2 u) {
    float alpha = vertex.material.alpha;
    bool mirror = HAS_MIRROR && (!HAS_ROUGH_METAL || alpha == 0.0);
    vec3 h = vec3(0.0, 0.0, 1.0);
    if (HAS_ROUGH_METAL && !mirror) h = sample_facets(vertex, u);
    vec3 wi = 2.0 * dot(vertex.wo, h) * h - vertex.wo;
    if (wi.z <= 0.0) return absorbed();
    vec3 direction = normalized(vertex.frame * wi);
    vec3 reflectance = metal_reflectance(vertex.material, dot(vertex.wo, h));
    if (mirror) return Scattering(direction, reflectance, 0.0, 1.0, false);
    float weight = facets_weight(vertex, wi);
    float pdf = pdf_facets(vertex, h);
    vec3 color = reflectance * weight;
    return Scattering(direction, color, pdf, 1.0, false);
}
