// Reflectance of metal: unpolarised Fresnel equations of a complex index of refraction n + i k.

// With t = n^2 - k^2 - sin^2: a^2 + b^2 = sqrt(t^2 + 4 n^2 k^2) and a^2 = (a^2 + b^2 + t) / 2, in the form
// that does not cancel where t is below 0.
float fresnel_conductor(float cosine, float n, float k) {
    float cos2 = cosine * cosine;
    float sin2 = max((1.0 - cosine) * (1.0 + cosine), 0.0);
    float t = (n - k) * (n + k) - sin2;
    float product = 2.0 * n * k;
    float sum = sqrt(t * t + product * product);
    float a2 = t >= 0.0 ? 0.5 * (sum + t) : 0.5 * product * product / (sum - t);
    float twice = 2.0 * cosine * sqrt(a2);
    float rs = (sum + cos2 - twice) / (sum + cos2 + twice);
    float even = cos2 * sum + sin2 * sin2;
    float odd = twice * sin2;
    float rp = even + odd > 0.0 ? rs * ((even - odd) / (even + odd)) : rs;
    float reflectance = 0.5 * (rs + rp);
    return reflectance;
}

// Reflectance of metal, at an angle to its normal or to the normal of its facet.
vec3 metal_reflectance(Material material, float cosine) {
    if (!HAS_CONDUCTOR || material.details == NO_DETAILS) return material.color;
    Conductor metal = conductor_at(material.details);
    vec3 reflectance = vec3(fresnel_conductor(cosine, metal.n.x, metal.k.x),
                                    fresnel_conductor(cosine, metal.n.y, metal.k.y),
                                    fresnel_conductor(cosine, metal.n.z, metal.k.z));
    reflectance *= material.color;
    return reflectance;
}

// Reflectance of a surface for light that comes along its normal; glass counts as black.
vec3 head_on_reflectance(Material material) {
    if (material.kind == DIELECTRIC || material.kind == PANE) return vec3(0.0);
    return material.kind == METAL ? metal_reflectance(material, 1.0) : material.color;
}
