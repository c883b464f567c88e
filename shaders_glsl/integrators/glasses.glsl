// The space between surfaces: glass that absorbs light by Beer's law, and glasses that overlap.
//
// NESTED_GLASSES: the number of glasses with a priority. They stand first among the rows of the struct Glass, highest
// priority first. For each of them, a path counts how many objects of this glass contain it. The first glass with
// a count above 0 is the one around the path (Schmidt and Budge, "Simple Nested Dielectrics in Ray Traced Images",
// JGT 2002).

const int BITS_OF_COUNT = 5;  // bits for one glass: a word holds MOST_GLASSES of them

bool is_nested(Material material) {
    if (!HAS_NESTED || material.kind != DIELECTRIC) return false;
    return material.details != NO_DETAILS && material.details < NESTED_GLASSES;
}

// The counts after the path has crossed an outer (`enters`) or an inner face of this glass.
uint counts_beyond(uint counts, int glass, bool enters) {
    uint one = 1u << uint(BITS_OF_COUNT * glass);
    uint own = counts >> uint(BITS_OF_COUNT * glass) & (1u << uint(BITS_OF_COUNT)) - 1u;
    if (enters) return counts + one;
    return own == 0u ? counts : counts - one;
}

// The row of the glass around the path, or NO_DETAILS in air.
int glass_around(uint counts) {
    return counts == 0u ? NO_DETAILS : findLSB(counts) / BITS_OF_COUNT;
}

float ior_around(uint counts) {
    int glass = glass_around(counts);
    if (glass == NO_DETAILS) return 1.0;
    return glass_at(glass).ior;
}

// The row with the facets of rough glass where another glass, or air, lies around it.
int facets_against(int glass, uint around) {
    int other = glass_around(around);
    return other > glass ? glass_at(glass).first_pair + other - glass - 1 : glass;
}

vec3 absorption_of_glass(int details) {
    if (details == NO_DETAILS) return vec3(0.0);
    return glass_at(details).absorption;
}

// The share of light that is left after a distance.
vec3 share_left(vec3 absorption, float distance) {
    vec3 depth = absorption * distance;
    return vec3(decay(depth.x), decay(depth.y), decay(depth.z));
}

// The share that is left of light from infinitely far away.
vec3 share_left_of_sky(vec3 absorption) {
    return vec3(equal(absorption, vec3(0.0)));
}
