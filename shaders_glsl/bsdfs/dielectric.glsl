// A smooth interface between two dielectrics.

// Unpolarised Fresnel reflectance. The squared cosine on the far side has the form that is exact
// for eta = 1; it is not above 0 where all light is reflected.
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

// Samples one of the two directions with the probability of its share: the weight is 1. Radiance that
// crosses is compressed into another solid angle and scales by eta^2.
Scattering sample_dielectric(Vertex vertex, float u) {
    float eta = vertex.eta;
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
    return Scattering(direction, crossing_tint(vertex.material), 0.0, scale, true);
}
