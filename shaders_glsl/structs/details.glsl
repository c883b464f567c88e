// What some materials have beside their row.

const int NO_DETAILS = -1;

// Metal by its complex index of refraction n + i k, in red, green and blue.
struct Conductor {
    vec3 n;
    int spare_a;  // fill the rows
    vec3 k;
    int spare_b;
};

// Glass that is rough, absorbs light, or has a priority over other glass; of those, the highest stands first.
struct Glass {
    vec3 absorption;       // per unit length; 0: clear
    int first_albedo;      // of the rows of its facets; below 0: what they lose is not restored
    float mean_outer;      // share of even light from outside that they lose
    float mean_inner;      // the same from inside
    float crossing_outer;  // of what they lose of light from outside, the share that crosses
    float crossing_inner;
    float ior;             // inside over air
};

// A principled surface, beside its colour and the alpha of its facets.
struct Gloss {
    vec3 f0;             // of its dielectric facets, head-on
    float f90;           // of the same, grazing
    float coat;          // weight of the coat; 0: none
    float coat_alpha;    // of its facets
    int first;           // of the rows of albedos of the facets
    int first_coat;      // of those of the coat
    float kept;          // share of even light that white facets do not lose to each other
    float spread;        // 1 / (1 - kept); 0 where nothing is lost
    float again;         // share of what dielectric facets lose that comes back, of the brightest channel
    float brightest;     // channel of f0
    float transmission;  // chance that a path meets its glass
    int glass;           // row of that among the materials
    int spare;           // fills the row
    float even_base;     // 1 over the share of even light that dielectric facets leave
};

// Directional albedos of facets, which scatter once: at both ends of a step of the root of the cosine. Of rough
// glass, of light from outside and from inside; of gloss, the factors of f0 and f90.
struct Albedo {
    float one;
    float other;
    float one_end;
    float other_end;
};
