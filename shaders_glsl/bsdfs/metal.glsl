// Mirrors, and rough metal: GGX with height-correlated Smith shadowing.

// Normal distribution at the half vector in the local frame. Its x and y keep the digits of
// narrow lobes, which 1 - h.z^2 would lose.
float ggx_d(float alpha, vec3 h) {
    float slope = dot(h.xy, h.xy) / (alpha * alpha) + h.z * h.z;
    float d = 1.0 / (PI * alpha * alpha * slope * slope);
    return d;
}

// 1 + Lambda, times 2 w.z: finite at grazing angles.
float ggx_shadow(float alpha, vec3 w) {
    float s = w.z + sqrt(w.z * w.z + alpha * alpha * dot(w.xy, w.xy));
    return s;
}

// G2 / G1(wo) with G1 = 1 / (1 + L(wo)), G2 = 1 / (1 + L(wo) + L(wi)) (Heitz, "Understanding the
// Masking-Shadowing Function", JCGT 2014, eq. 99).
float ggx_weight(float alpha, vec3 wo, vec3 wi) {
    float so = ggx_shadow(alpha, wo) * wi.z;
    float si = ggx_shadow(alpha, wi) * wo.z;
    float both = so + si - 2.0 * wo.z * wi.z;
    float weight = so / both;
    return weight;
}

// Density of the visible normals of wo, reflected: G1(wo) D(h) / (4 wo.z).
float pdf_ggx(float alpha, vec3 wo, vec3 h) {
    float pdf = ggx_d(alpha, h) / (2.0 * ggx_shadow(alpha, wo));
    return pdf;
}

// Samples a visible normal (Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023).
vec3 sample_ggx_normal(float alpha, vec3 wo, vec2 u) {
    vec3 w = normalized(vec3(alpha * wo.xy, wo.z));
    float phi = 2.0 * PI * u.x;
    float z = (1.0 - u.y) * (1.0 + w.z) - w.z;
    float r = sqrt(max((1.0 - z) * (1.0 + z), 0.0));
    vec3 h = vec3(r * cos(phi), r * sin(phi), z) + w;
    vec3 normal = normalized(vec3(alpha * h.xy, max(h.z, 0.0)));
    return normal;
}

vec3 eval_metal(Vertex vertex, vec3 wi) {
    Material material = vertex.material;
    vec3 h = normalized(vertex.wo + wi);
    float density = pdf_ggx(material.alpha, vertex.wo, h);
    float weight = ggx_weight(material.alpha, vertex.wo, wi);
    vec3 reflectance = metal_reflectance(material, dot(vertex.wo, h));
    vec3 value = reflectance * (density * weight);
    return value;
}

float pdf_metal(Vertex vertex, vec3 wi) {
    vec3 h = normalized(vertex.wo + wi);
    return pdf_ggx(vertex.material.alpha, vertex.wo, h);
}

Scattering sample_metal(Vertex vertex, vec2 u) {
    float alpha = vertex.material.alpha;
    bool mirror = HAS_MIRROR && (!HAS_ROUGH_METAL || alpha == 0.0);
    vec3 h = vec3(0.0, 0.0, 1.0);
    if (HAS_ROUGH_METAL && !mirror) h = sample_ggx_normal(alpha, vertex.wo, u);
    vec3 wi = 2.0 * dot(vertex.wo, h) * h - vertex.wo;
    if (wi.z <= 0.0) return absorbed();
    vec3 direction = normalized(vertex.frame * wi);
    vec3 reflectance = metal_reflectance(vertex.material, dot(vertex.wo, h));
    if (mirror) return Scattering(direction, reflectance, 0.0, 1.0, false);
    float weight = ggx_weight(alpha, vertex.wo, wi);
    float pdf = pdf_ggx(alpha, vertex.wo, h);
    vec3 color = reflectance * weight;
    return Scattering(direction, color, pdf, 1.0, false);
}
