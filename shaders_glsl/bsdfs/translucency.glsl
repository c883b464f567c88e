// A matte base that lets light through, as leaves and paper do (KHR_materials_diffuse_transmission of glTF). A share
// of it reflects nothing, and scatters light by Lambert's law to the other side of the surface.

struct Translucency {
    vec3 color;   // albedo of what crosses: the share times its colour
    float share;  // of the base
};

bool is_translucent(Gloss gloss) {
    return gloss.glass < 0;
}

// It follows the albedos of sheen, in a row of its own.
Translucency translucency_of(Gloss gloss) {
    Albedo row = albedo_at(1 - gloss.glass + ALBEDO_STEPS);
    return Translucency(vec3(row.one, row.other, row.one_end), row.other_end);
}

// Whether light is scattered to both sides of a surface, by rough glass or by a base that lets it through.
bool scatters_across(Material material) {
    if (is_rough_glass(material)) return true;
    if (!HAS_TRANSLUCENCY || material.kind != PRINCIPLED) return false;
    Gloss gloss = gloss_at(material.details);
    return is_translucent(gloss) && translucency_of(gloss).share > 0.0;
}
