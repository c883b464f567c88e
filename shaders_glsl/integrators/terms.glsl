// Light of a path by terms. Emission is light that nothing scatters. The rest is sorted twice: by the number of
// scattering events, and by the kind of the first one, seen from the camera.
//
// LIGHT_TERMS: the terms that are kept, a bit each, counted from EMISSION. 0: none, and nothing is sorted.

const int TERMS = 7;

struct Terms {
    vec3 base;  // share of the light that a matte base scatters first
    int rest;   // what scatters the rest first: GLOSSY, TRANSMISSION or VOLUME
    vec3 light[TERMS];
};

Terms no_terms() {
    vec3 none = vec3(0.0);
    return Terms(none, GLOSSY, vec3[TERMS](none, none, none, none, none, none, none));
}

bool is_kept(int term) {
    return (LIGHT_TERMS >> term & 1) != 0;
}

void add_to_term(inout Terms self, int aov, vec3 light) {
    for (int i = 0; i < TERMS; i += 1) {
        if (i == aov - EMISSION) self.light[i] += light;
    }
}

// Adds light that was scattered `length` times.
void sort_light(inout Terms self, vec3 light, int length) {
    if (length == 0) {
        add_to_term(self, EMISSION, light);
        return;
    }
    add_to_term(self, length == 1 ? DIRECT : INDIRECT, light);
    vec3 diffuse = light * self.base;
    add_to_term(self, DIFFUSE, diffuse);
    vec3 rest = light - diffuse;
    add_to_term(self, self.rest, rest);
}
