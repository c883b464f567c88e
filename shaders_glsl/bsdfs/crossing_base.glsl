// Light that crosses a principled surface, whose matte base lets it through. The layers above the base are the same on
// both sides.

// The chance that a sample of the base crosses the surface.
float crossing_chance(Principled it, Shares shares) {
    float all = mean_of(light_of_base(it, shares));
    if (all <= 0.0) return 0.0;
    float chance = mean_of(it.through * shares.base) / all;
    return chance;
}

// The factor by which layers above the base and the facets hold light back, on its way in and out.
float held_back(Gloss gloss, float one, float other) {
    float left = 1.0;
    if (HAS_SHEEN && has_sheen(gloss)) left *= min(below_sheen(gloss, one), below_sheen(gloss, other));
    if (HAS_COAT && gloss.coat > 0.0) left *= min(below_coat(gloss, one), below_coat(gloss, other));
    return left;
}

// Value and density of light that crosses the surface; wi.z < 0.
ColorLobe crossing_lobe(Principled it, Vertex vertex, vec3 wi) {
    Gloss gloss = it.gloss;
    vec3 mirrored = vec3(wi.xy, -wi.z);
    Shares from = shares_of(vertex, gloss, mirrored);
    Shares to = shares_of(vertex, gloss, vertex.wo);
    float even = mirrored.z / PI;
    float left = held_back(gloss, mirrored.z, vertex.wo.z);
    vec3 value = it.through * (from.base * to.base * gloss.even_base * left * even);
    float pdf = lobe_chances(it, vertex.wo.z, to).z * crossing_chance(it, to) * even;
    return ColorLobe(value, pdf);
}

// A sample that crosses the surface, opposite to a direction above it.
Scattering sample_across(Principled it, Vertex vertex, vec3 above) {
    vec3 wi = vec3(above.xy, -above.z);
    ColorLobe lobe = crossing_lobe(it, vertex, wi);
    if (lobe.pdf == 0.0) return absorbed();
    vec3 direction = normalized(vertex.frame * wi);
    vec3 weight = lobe.value / lobe.pdf;
    return Scattering(direction, weight, lobe.pdf, 1.0, true);
}
