// Types and notation shared by all BSDFs. BSDFs are sampled, evaluated, and asked for a density:
//   wo   unit, towards where the path came from     wi   unit, towards where it goes
//   n    unit normal on the side of wo              h    half vector of wo and wi
//   eta  index of refraction here over there        pdf  density per solid angle, 0: delta
// In local frames n is +z. eval_x contains the cosine, so that a sample's weight is eval / pdf.

struct Vertex {
    mat3 frame;         // world from local
    vec3 wo;            // local, z > 0
    Material material;
    bool is_outside;    // whether wo is on the outer side of the surface
    float eta;          // index of refraction here over there
};

struct Scattering {
    vec3 direction;  // world
    vec3 weight;     // eval / pdf; 0: absorbed
    float pdf;
    float scale;     // of radiance, by refraction: eta^2
    bool crosses;    // through the surface
};

// `is_outside`: whether wo is on the outer side of the surface.
Vertex vertex_of(mat3 frame, vec3 wo, Material material, bool is_outside) {
    float eta = is_outside ? 1.0 / material.ior : material.ior;
    return Vertex(frame, wo, material, is_outside, eta);
}

// Colour of light that crosses glass, without the absorption inside it. It is not white where the glass is a part
// of a principled surface.
vec3 crossing_tint(Material material) {
    return HAS_TRANSMISSION ? material.color : vec3(1.0);
}

Scattering absorbed() {
    return Scattering(vec3(0.0), vec3(0.0), 0.0, 1.0, false);
}
