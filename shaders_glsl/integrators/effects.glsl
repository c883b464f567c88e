// Effects of rays that method hybrid adds to a rasterised picture: EFFECTS has a bit for each that is on, and the bit
// BY_CHOICE. It is 0 in methods that trace all light.

const int SHADOWS = 1;            // lamps and the sun are hidden
const int REFLECTIONS = 2;        // metal, glass and principled surfaces reflect others
const int REFRACTIONS = 4;        // glass shows what is behind it
const int AMBIENT_OCCLUSION = 8;  // the background is hidden
const int GI = 16;                // indirect light of matte surfaces, from probes

const int BY_CHOICE = 32;

const bool CHOSEN = EFFECTS != 0;

bool has_effect(int effect) { return !CHOSEN || (EFFECTS & effect) != 0; }

// Whether light that falls on a surface is followed no farther than to a lamp or the background. Glass divides light
// into two parts, each an effect of its own.
bool ends_paths(Material material) {
    if (!CHOSEN || HAS_DIELECTRIC && material.kind == DIELECTRIC || HAS_PANE && material.kind == PANE) return false;
    return material.kind == MATTE || !has_effect(REFLECTIONS);
}

// Whether an effect that is off would send the path on from glass.
bool is_left_out(Material material, bool crosses) {
    if (!CHOSEN || ends_paths(material)) return false;
    return !has_effect(crosses ? REFRACTIONS : REFLECTIONS);
}
