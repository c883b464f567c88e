// A thin film on facets, whose two reflections interfere: iridescence (Belcour and Barla, "A Practical Extension to
// Microfacet Theory for the Modeling of Varying Iridescence", 2017), as KHR_materials_iridescence of glTF puts it.
// Reflectances follow Schlick. The surface below may be a dielectric or a metal, by its reflectance head-on.

struct ThinFilm {
    float share;      // of the surface that the film covers
    float ior;        // of the film
    float thickness;  // micrometres
    float edge;       // factor of grazing light in a bound of the reflectance: glrt/scene/materials/thin_film.py
};

// Rows of the struct Albedo that follow the albedos hold films: a material names its film by a number below 0.
bool has_film(Gloss gloss) {
    return gloss.glass < 0;
}

ThinFilm film_of(Gloss gloss) {
    Albedo row = albedo_at(-1 - gloss.glass);
    return ThinFilm(row.one, row.other, row.one_end, row.other_end);
}

// The Fourier transform of the sensitivity of the eye, as Gaussians of CIE XYZ (section 5 there), in linear sRGB.
// path: optical path, in micrometres.
vec3 interference(float path) {
    float phase = 2.0 * PI * path;
    float square = phase * phase;
    vec3 height = vec3(0.84659001, 1.00022189, 1.00112249);
    vec3 left = vec3(decay(4.3278e-3 * square), decay(9.3046e-3 * square), decay(6.6121e-3 * square));
    vec3 xyz = height * cos(vec3(1.6810, 1.7953, 2.2084) * phase) * left;
    xyz.x += 0.15386831 * cos(2.2399 * phase) * decay(4.5282e-3 * square);
    float red = 3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z;
    float green = -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z;
    float blue = 0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z;
    return vec3(red, green, blue);
}

float interface_reflectance(float inner, float outer) {
    float root = (inner - outer) / (inner + outer);
    float reflectance = root * root;
    return reflectance;
}

// Reflectance of a film in air on a surface that reflects f0 head-on. Light that is reflected more than three times
// inside the film interferes no more.
vec3 film_reflectance(ThinFilm film, vec3 f0, float cosine) {
    float sine2 = max((1.0 - cosine) * (1.0 + cosine), 0.0);
    float inside = sqrt(1.0 - sine2 / (film.ior * film.ior));
    float outer = interface_reflectance(film.ior, 1.0);
    outer += (1.0 - outer) * schlick_weight(cosine);
    float crossed = 1.0 - outer;
    float edge = schlick_weight(inside);
    float path = 2.0 * film.ior * film.thickness * inside;
    vec3 once = 2.0 * interference(path);
    vec3 twice = 2.0 * interference(2.0 * path);
    vec3 found;
    for (int i = 0; i < 3; i += 1) {
        float root = sqrt(clamp(f0[i], 0.0, 0.9999));
        float below = (1.0 + root) / (1.0 - root);
        float inner = interface_reflectance(below, film.ior);
        inner += (1.0 - inner) * edge;
        float both = min(outer * inner, 0.9999);
        float even = crossed * crossed * inner / (1.0 - both);
        float r = below < film.ior ? sqrt(both) : -sqrt(both);  // the sign: a shift of phase by pi
        float waves = r * (once[i] + r * twice[i]);
        found[i] = outer + even + (even - crossed) * waves;
    }
    vec3 reflectance = clamp(found, 0.0, 1.0);
    return reflectance;
}
