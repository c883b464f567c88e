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
    vec3 along;         // world: where HAS_ANISOTROPY, facets are rougher along it, and frame[0] follows it
    float stretch;      // alpha along it over alpha across; 1: facets are alike all round
    vec3 etas;          // where HAS_DISPERSION: eta of each channel; 0 where the path has no light in it
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
    return Vertex(frame, wo, material, is_outside, eta, vec3(0.0), 1.0, vec3(eta));
}

// The frame, turned about its normal so that its first column lies along a direction, as far as that can be.
mat3 frame_along(mat3 frame, vec3 along) {
    vec3 n = frame[2];
    vec3 x = along - dot(along, n) * n;
    float square = dot(x, x);
    if (!(square > 0.0)) return frame;
    x /= sqrt(square);
    return mat3(x, cross(n, x), n);
}

// The same vertex with facets that are rougher along a direction.
Vertex vertex_along(Vertex vertex, vec3 along, float stretch) {
    mat3 frame = frame_along(vertex.frame, along);
    vec3 wo = to_local(frame, normalized(vertex.frame * vertex.wo));
    return Vertex(frame, wo, vertex.material, vertex.is_outside, vertex.eta, along, stretch, vertex.etas);
}

// Colour of light that crosses glass, without the absorption inside it. It is not white where the glass is a part
// of a principled surface.
vec3 crossing_tint(Material material) {
    return HAS_TRANSMISSION ? material.color : vec3(1.0);
}

// Value of a BSDF, which contains the cosine, and density.
struct Lobe {
    float value;
    float pdf;
};

Scattering absorbed() {
    return Scattering(vec3(0.0), vec3(0.0), 0.0, 1.0, false);
}
