// Phong's model with constants for all surfaces, where OWN_PHONG: [render.phong] of scene files.
//
//   ambient C + sum over lamps of E / PI (diffuse C N.L + specular highlight^exponent)
//
// C: colour; E: irradiance of a surface that faces the lamp; highlight: N.H (BLINN), or the cosine between the light
// and the mirrored view (PHONG). Source: Whitted, "An improved illumination model for shaded display", 1980, eq. 1,
// with factors of 1 / PI that make 1 a white surface; Appendix A of the thesis.

struct Phong {
    float ambient;  // below 0, as each of the others: as the material has it
    float diffuse;
    float specular;
    int exponent;
};

Phong own_phong() {
    return Phong(frame.phong_ambient, frame.phong_diffuse, frame.phong_specular, frame.phong_exponent);
}

float phong_highlight(int exponent, vec3 wo, vec3 wi) {
    float along = MODEL == BLINN ? normalized(wo + wi).z : dot(vec3(-wo.xy, wo.z), wi);
    return whole_power(max(along, 0.0), exponent);
}

// Value of a surface for light from wi; it contains the cosine.
struct Shading {
    vec3 base;
    vec3 gloss;
};

Shading phong_shading(Phong self, Vertex vertex, vec3 wi) {
    Material material = vertex.material;
    vec3 own = eval_local(vertex, wi);
    vec3 base = own * base_share(vertex, wi);
    vec3 gloss = own - base;
    if (self.diffuse >= 0.0) base = head_on_reflectance(material) * (self.diffuse * wi.z / PI);
    bool is_unlit = HAS_PRINCIPLED && material.kind == PRINCIPLED && own == vec3(0.0);
    if (self.specular < 0.0 || is_unlit || material.kind == DIELECTRIC || material.kind == PANE) return Shading(base, gloss);
    gloss = vec3(self.specular / PI * phong_highlight(self.exponent, vertex.wo, wi));
    return Shading(base, gloss);
}

// The share of the base in what a surface scatters from wi; 0 where it scatters nothing.
vec3 phong_base_share(Vertex vertex, vec3 wi) {
    Shading shading = phong_shading(own_phong(), vertex, wi);
    vec3 whole = shading.base + shading.gloss;
    vec3 share = vec3(0.0);
    for (int i = 0; i < 3; i += 1) {
        if (whole[i] > 0.0) share[i] = shading.base[i] / whole[i];
    }
    return share;
}
