// Sheen of cloth: fibres that stand on the surface, lit from behind and from the side (KHR_materials_sheen of glTF).
// The distribution is Charlie's (Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", 2017), and shadowing
// that of Neubelt and Pettineo ("Crafting a Next-Gen Material Pipeline for The Order: 1886", 2013).

struct Sheen {
    vec3 color;
    float power;  // half of 1 / alpha
    int first;    // first row of its albedos
};

bool has_sheen(Gloss gloss) {
    return gloss.glass < 0;
}

// It follows the thin film of a material among the albedos, in a row of its own, and its albedos follow that.
Sheen sheen_of(Gloss gloss) {
    int place = -gloss.glass;
    Albedo row = albedo_at(place);
    return Sheen(vec3(row.one, row.other, row.one_end), row.other_end, place + 1);
}

float brightest_of(vec3 color) {
    float brightest = max(color.x, max(color.y, color.z));
    return brightest;
}

// Value for white, which contains the cosine. The lobe reflects more than all light where it is narrow and grazes. It
// is held back by the larger albedo of the two directions, which is as symmetric as the lobe.
float eval_white_sheen(Sheen sheen, vec3 wo, vec3 wi, vec3 h) {
    float sine2 = dot(h.xy, h.xy);
    if (sine2 == 0.0) return 0.0;
    float d = (1.0 + sheen.power) / PI * decay(-sheen.power * ln(min(sine2, 1.0)));
    float value = d * wi.z / (4.0 * (wo.z + wi.z - wo.z * wi.z));
    float most = max(albedos(sheen.first, wo.z).x, albedos(sheen.first, wi.z).x);
    value /= max(most, 1.0);
    return value;
}

// The share of light from a direction that sheen leaves to what is below.
float below_sheen(Gloss gloss, float cosine) {
    if (!has_sheen(gloss)) return 1.0;
    Sheen sheen = sheen_of(gloss);
    float left = 1.0 - brightest_of(sheen.color) * albedos(sheen.first, cosine).y;
    return left;
}
