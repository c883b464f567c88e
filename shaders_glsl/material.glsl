// How surfaces scatter: sample, evaluate, density. The legend of the field:
//   wo   unit, towards where the path came from     wi   unit, towards where it goes
//   n    unit normal on the side of wo              h    half vector of wo and wi
//   eta  index of refraction here over there        pdf  density per solid angle, 0: delta
// In local frames n is +z. eval_x contains the cosine, so that a sample's weight is eval / pdf.

struct Vertex {
    mat3 frame;         // world from local
    vec3 wo;            // local, z > 0
    Material material;
};

struct Scattering {
    vec3 direction;  // world
    vec3 weight;     // eval / pdf; 0: absorbed
    float pdf;
    float scale;     // of radiance, by refraction: (eta)^2
    bool crosses;    // through the surface
};

bool is_delta(Material material) {
    if (HAS_DIELECTRIC && material.kind == DIELECTRIC) return true;
    return HAS_MIRROR && material.kind == METAL && material.alpha == 0.0;
}

// --- matte ---------------------------------------------------------------------------------

vec3 eval_matte(vec3 color, vec3 wi) {
    vec3 value = color * (wi.z / PI);
    return value;
}

float pdf_matte(vec3 wi) {
    float pdf = wi.z / PI;
    return pdf;
}

// --- rough metal: GGX with height-correlated Smith shadowing ---------------------------------

// Normal distribution, from the half vector in the local frame (its x and y keep the digits of
// narrow lobes, which 1 - h.z^2 would lose).
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

// A visible normal (Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023).
vec3 sample_ggx_normal(float alpha, vec3 wo, vec2 u) {
    vec3 w = normalized(vec3(alpha * wo.xy, wo.z));
    float phi = 2.0 * PI * u.x;
    float z = (1.0 - u.y) * (1.0 + w.z) - w.z;
    float r = sqrt(max((1.0 - z) * (1.0 + z), 0.0));
    vec3 h = vec3(r * cos(phi), r * sin(phi), z) + w;
    vec3 normal = normalized(vec3(alpha * h.xy, max(h.z, 0.0)));
    return normal;
}

// --- smooth dielectric -----------------------------------------------------------------------

// Unpolarised Fresnel reflectance. The squared cosine on the far side in the form that is exact
// for eta = 1; not above 0 where all light is reflected.
float refracted_cos2(float cos_i, float eta) {
    float cos2 = (1.0 - eta) * (1.0 + eta) + eta * eta * (cos_i * cos_i);
    return cos2;
}

float fresnel(float cos_i, float eta) {
    float cos2_t = refracted_cos2(cos_i, eta);
    if (cos2_t <= 0.0) return 1.0;
    float cos_t = sqrt(cos2_t);
    float rs = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    float rp = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    float reflectance = 0.5 * (rs * rs + rp * rp);
    return reflectance;
}

// --- all kinds -------------------------------------------------------------------------------

vec3 eval_material(Vertex vertex, vec3 wi) {
    Material material = vertex.material;
    if (HAS_ROUGH_METAL && material.kind == METAL) {
        vec3 h = normalized(vertex.wo + wi);
        float density = pdf_ggx(material.alpha, vertex.wo, h);
        float weight = ggx_weight(material.alpha, vertex.wo, wi);
        vec3 value = material.color * (density * weight);
        return value;
    }
    return eval_matte(material.color, wi);
}

float pdf_material(Vertex vertex, vec3 wi) {
    if (HAS_ROUGH_METAL && vertex.material.kind == METAL) {
        vec3 h = normalized(vertex.wo + wi);
        return pdf_ggx(vertex.material.alpha, vertex.wo, h);
    }
    return pdf_matte(wi);
}

Scattering absorbed() {
    return Scattering(vec3(0.0), vec3(0.0), 0.0, 1.0, false);
}

Scattering sample_matte(Vertex vertex, vec2 u) {
    vec3 wi = sample_cosine_hemisphere(u);
    vec3 direction = normalized(vertex.frame * wi);
    return Scattering(direction, vertex.material.color, pdf_matte(wi), 1.0, false);
}

Scattering sample_metal(Vertex vertex, vec2 u) {
    float alpha = vertex.material.alpha;
    bool mirror = HAS_MIRROR && (!HAS_ROUGH_METAL || alpha == 0.0);
    vec3 h = vec3(0.0, 0.0, 1.0);
    if (HAS_ROUGH_METAL && !mirror) h = sample_ggx_normal(alpha, vertex.wo, u);
    vec3 wi = 2.0 * dot(vertex.wo, h) * h - vertex.wo;
    if (wi.z <= 0.0) return absorbed();
    vec3 direction = normalized(vertex.frame * wi);
    if (mirror) return Scattering(direction, vertex.material.color, 0.0, 1.0, false);
    float weight = ggx_weight(alpha, vertex.wo, wi);
    float pdf = pdf_ggx(alpha, vertex.wo, h);
    vec3 color = vertex.material.color * weight;
    return Scattering(direction, color, pdf, 1.0, false);
}

// One of the two directions, with the probability of its share: the weight is 1. Radiance that
// crosses is squeezed into another solid angle and scales by eta^2.
Scattering sample_dielectric(Vertex vertex, float eta, float u) {
    float cos_i = vertex.wo.z;
    vec3 n = vertex.frame[2];
    vec3 incoming = -(vertex.frame * vertex.wo);
    if (u < fresnel(cos_i, eta)) {
        vec3 direction = normalized(incoming + 2.0 * cos_i * n);
        return Scattering(direction, vec3(1.0), 0.0, 1.0, false);
    }
    float cos_t = sqrt(max(refracted_cos2(cos_i, eta), 0.0));
    vec3 direction = normalized(eta * incoming + (eta * cos_i - cos_t) * n);
    float scale = eta * eta;
    return Scattering(direction, vec3(1.0), 0.0, scale, true);
}

// `outside`: whether wo is on the outer side of the surface.
Scattering sample_material(Vertex vertex, bool outside, inout Sampler rng) {
    Material material = vertex.material;
    if (HAS_DIELECTRIC && material.kind == DIELECTRIC) {
        float eta = outside ? 1.0 / material.ior : material.ior;
        float u = next_1d(rng);
        return sample_dielectric(vertex, eta, u);
    }
    vec2 u = next_2d(rng);
    if ((HAS_MIRROR || HAS_ROUGH_METAL) && material.kind == METAL) return sample_metal(vertex, u);
    return sample_matte(vertex, u);
}
