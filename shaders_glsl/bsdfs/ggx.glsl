// Rough facets: GGX with height-correlated Smith shadowing.

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

// The weight of f90 against f0 in Schlick's reflectance.
float schlick_weight(float cosine) {
    float x = max(1.0 - cosine, 0.0);
    float x2 = x * x;
    float weight = x2 * x2 * x;
    return weight;
}

// Facets of a vertex may be rougher along frame[0] than across it (KHR_materials_anisotropy of glTF). Their alpha
// across is that of the material, and k = vertex.stretch times as much along it. The formulas of even facets then hold
// for directions with k w.x in place of w.x, and for half vectors with h.x / k; the distribution is divided by k
// (Heitz 2014, section 5.3).

vec3 stretched(Vertex vertex, vec3 w) {
    if (!HAS_ANISOTROPY) return w;
    float x = vertex.stretch * w.x;
    return vec3(x, w.yz);
}

float pdf_facets(Vertex vertex, vec3 h) {
    float alpha = vertex.material.alpha;
    if (!HAS_ANISOTROPY) return pdf_ggx(alpha, vertex.wo, h);
    float k = vertex.stretch;
    float x = h.x / k;
    float density = ggx_d(alpha, vec3(x, h.yz)) / (2.0 * k * ggx_shadow(alpha, stretched(vertex, vertex.wo)));
    return density;
}

float facets_weight(Vertex vertex, vec3 wi) {
    float alpha = vertex.material.alpha;
    return ggx_weight(alpha, stretched(vertex, vertex.wo), stretched(vertex, wi));
}

vec3 sample_facets(Vertex vertex, vec2 u) {
    float alpha = vertex.material.alpha;
    vec3 h = sample_ggx_normal(alpha, stretched(vertex, vertex.wo), u);
    if (HAS_ANISOTROPY) h = normalized(stretched(vertex, h));
    return h;
}
