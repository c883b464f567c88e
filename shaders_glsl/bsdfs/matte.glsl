// Lambert's law.

vec3 eval_matte(vec3 color, vec3 wi) {
    vec3 value = color * (wi.z / PI);
    return value;
}

float pdf_matte(vec3 wi) {
    float pdf = wi.z / PI;
    return pdf;
}

Scattering sample_matte(Vertex vertex, vec2 u) {
    vec3 wi = sample_cosine_hemisphere(u);
    vec3 direction = normalized(vertex.frame * wi);
    return Scattering(direction, vertex.material.color, pdf_matte(wi), 1.0, false);
}
