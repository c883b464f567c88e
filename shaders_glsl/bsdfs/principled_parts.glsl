// A coat over facets over a matte base: glTF's metallic roughness. The facets are metal and dielectric in parts.
//
// Facets are GGX with Schlick's reflectance f0 + (f90 - f0) (1 - cos)^5. The layers below get the light that the facets
// leave on its way in and out, in forms that are symmetric and never gain energy (E: directional albedo):
//   the base, (1 - E(wo)) (1 - E(wi)) / mean(1 - E) of the dielectric facets (Kelemen and Szirmay-Kalos, "A
//   Microfacet Based Coupled Specular-Matte BRDF Model with Importance Sampling", 2001);
//   all layers below the coat, the lesser of 1 - E(wo) and 1 - E(wi) of the coat.
// Under a thin film E is of a bound of its reflectance. Sheen lies between the coat and the facets, and lets light
// through by the rule of the coat.
// Light that facets lose to each other comes back as one lobe (Kulla and Conty 2017, as in rough_dielectric.glsl).
// Smooth facets are deltas: they are sampled, but have neither a value nor a density.

const float COAT_F0 = 0.04;  // of an index of refraction of 1.5

// The part of a surface that a path meets, where the surface is glass in part: the glass, or the rest.
Material met_part(Material material, float u) {
    Gloss gloss = gloss_at(material.details);
    float share = gloss.transmission;
    if (HAS_TRANSMISSION_MAP) {
        share *= clamp(material.crossed, 0.0, 1.0);
        float whole = material.metallic * (1.0 - gloss.transmission);  // of the whole; below of the rest
        if (share < 1.0) material.metallic = whole / (1.0 - share);
    }
    if (u >= share) return material;
    Material glass = material_at(gloss.glass);
    glass.color = material.color;
    return glass;
}

// The facets of a surface, metal and dielectric together, and its base. A thin film on them is not in f0 and f90.
struct Principled {
    Gloss gloss;
    vec3 f0;
    float f90;
    vec3 again;  // share of light that comes back after several facets
    vec3 base;     // albedo
    vec3 through;  // albedo of the base for light that crosses the surface
};

// Share of the light that facets lose to each other which comes back, F^2 E / (1 - F (1 - E)). The mean reflectance F
// is f0 + (f90 - f0) / 21.
vec3 sent_back(vec3 f0, float f90, float kept) {
    vec3 mean = f0 + (f90 - f0) / 21.0;
    vec3 share = mean * mean * kept / (1.0 - mean * (1.0 - kept));
    return share;
}

Principled principled_of(Material material) {
    Gloss gloss = gloss_at(material.details);
    vec3 f0 = gloss.f0 + material.metallic * (material.color - gloss.f0);
    float f90 = gloss.f90 + material.metallic * (1.0 - gloss.f90);
    vec3 of_dielectric = sent_back(gloss.f0, gloss.f90, gloss.kept);
    vec3 of_metal = sent_back(material.color, 1.0, gloss.kept);
    vec3 again = of_dielectric + material.metallic * (of_metal - of_dielectric);
    vec3 base = (1.0 - material.metallic) * material.color;
    if (!HAS_TRANSLUCENCY || !is_translucent(gloss)) return Principled(gloss, f0, f90, again, base, vec3(0.0));
    Translucency crossing = translucency_of(gloss);
    base *= 1.0 - crossing.share;
    vec3 through = (1.0 - material.metallic) * crossing.color;
    return Principled(gloss, f0, f90, again, base, through);
}

// Reflectance of facets for light at an angle to their normal; edge: the weight of Schlick at that angle. A film
// lies on all of them: on metal over its colour, and on the rest over f0 without `specular`, which is f90.
vec3 facet_reflectance(Principled it, Material material, float cosine, float edge) {
    vec3 plain = it.f0 + (it.f90 - it.f0) * edge;
    if (!HAS_IRIDESCENCE || !has_film(it.gloss)) return plain;
    ThinFilm film = film_of(it.gloss);
    float specular = it.gloss.f90;
    vec3 found = vec3(0.0);
    if (material.metallic < 1.0 && specular > 0.0) {
        found = specular * film_reflectance(film, it.gloss.f0 / specular, cosine);
    }
    if (material.metallic > 0.0) {
        vec3 of_metal = film_reflectance(film, material.color, cosine);
        found += material.metallic * (of_metal - found);
    }
    vec3 reflectance = plain + film.share * (found - plain);
    return reflectance;
}

// The factors of f0 and f90 in the light that facets reflect from a direction. Facets that are rougher along x have
// tables at even steps of |y| / (r |x| + |y|), where r is the root of how much rougher they are.
vec2 albedos_around(Vertex vertex, Gloss gloss, vec3 w) {
    if (!HAS_ANISOTROPY || gloss.turns == 0) return albedos(gloss.first, w.z);
    float x = sqrt(vertex.stretch) * abs(w.x);
    float y = abs(w.y);
    float place = (y > 0.0 ? y / (x + y) : 0.0) * float(gloss.turns);
    int turn = min(int(place), gloss.turns - 1);
    vec2 start = albedos(gloss.first + turn * ALBEDO_STEPS, w.z);
    vec2 end = albedos(gloss.first + (turn + 1) * ALBEDO_STEPS, w.z);
    vec2 share = start + (place - float(turn)) * (end - start);
    return share;
}

// Shares of light from a direction: reflected by facets, as factors of f0 and f90, and lost by facets to each other.
struct Shares {
    vec2 facets;
    float lost;
    float base;  // left by dielectric facets
};

Shares shares_of(Vertex vertex, Gloss gloss, vec3 w) {
    vec2 facets = albedos_around(vertex, gloss, w);
    float lost = 1.0 - facets.x - facets.y;
    float edge = gloss.f90;
    if (HAS_IRIDESCENCE && has_film(gloss)) edge = film_of(gloss).edge;
    float taken = gloss.brightest * facets.x + edge * facets.y + gloss.again * lost;
    float left = 1.0 - taken;
    if (HAS_IRIDESCENCE) left = max(left, 0.0);
    return Shares(facets, lost, left);
}

// The share of light from a direction that the coat leaves.
float below_coat(Gloss gloss, float cosine) {
    if (!HAS_COAT || gloss.coat == 0.0) return 1.0;
    vec2 facets = albedos(gloss.first_coat, cosine);
    float left = 1.0 - gloss.coat * (COAT_F0 * facets.x + facets.y);
    return left;
}

float mean_of(vec3 color) {
    float mean = (color.x + color.y + color.z) / 3.0;
    return mean;
}

// Light of the base, that which crosses the surface too, with the light that facets lose.
vec3 light_of_base(Principled it, Shares shares) {
    vec3 albedo = it.base;
    if (HAS_TRANSLUCENCY) albedo += it.through;
    vec3 light = albedo * shares.base + it.again * shares.lost;
    return light;
}

// Chances that a sample is of the coat, of the facets, of the base with the light that facets lose, or of sheen. They
// are about the shares of these in light that comes from wo.
vec4 lobe_chances(Principled it, float cosine, Shares shares) {
    float left = below_coat(it.gloss, cosine);
    float facets = left * mean_of(it.f0 * shares.facets.x + it.f90 * shares.facets.y);
    float base = left * mean_of(light_of_base(it, shares));
    float sheen = 0.0;
    if (HAS_SHEEN && has_sheen(it.gloss)) {
        Sheen above = sheen_of(it.gloss);
        float below = below_sheen(it.gloss, cosine);
        facets *= below;
        base *= below;
        sheen = left * mean_of(above.color) * albedos(above.first, cosine).y;
    }
    float all = 1.0 - left + facets + base + sheen;
    if (all <= 0.0) return vec4(0.0, 0.0, 1.0, 0.0);
    vec4 chances = vec4(1.0 - left, facets, base, sheen) / all;
    return chances;
}

// Value of a BSDF, which contains the cosine, and density.
struct ColorLobe {
    vec3 value;
    float pdf;
};
