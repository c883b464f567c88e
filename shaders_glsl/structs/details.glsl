// Details: data of some materials that their row in Material does not hold.

const int NO_DETAILS = -1;

// these fill the rows
struct Conductor {
    vec3 n;
    int spare_a;  // fill the rows
    vec3 k;
    int spare_b;
};

// Glass that is rough, absorbs light, or has a priority over other glass. Glass of the highest priority stands first.
// Rows after them hold the facets of rough glass with a priority against each glass of a lower priority.
struct Glass {
    vec3 absorption;       // per unit length; 0: clear
    int first_albedo;      // first row of the albedos of its facets; below 0: light that facets lose is not restored
    float mean_outer;      // share of even light from outside that the facets lose
    float mean_inner;      // the same from inside
    float crossing_outer;  // share of the lost light from outside that crosses
    float crossing_inner;
    float ior;             // index of refraction, inside over air
    int first_pair;        // of rough glass with a priority: first row of its facets against other glass
};

// A principled surface: all but its colour and the alpha of its facets.
struct Gloss {
    vec3 f0;             // of its dielectric facets, head-on
    float f90;           // the same at grazing angles
    float coat;          // weight of the coat; 0: none
    float coat_alpha;    // alpha of the coat's facets
    int first;           // first row of the albedos of the facets
    int first_coat;      // first row of the albedos of the coat
    float kept;          // share of even light that white facets do not lose to each other
    float spread;        // 1 / (1 - kept); 0 where nothing is lost
    float again;         // share of the light lost by dielectric facets that comes back, in the brightest channel
    float brightest;     // largest channel of f0; under a thin film, f0 of a bound of the reflectance
    float transmission;  // chance that a path meets its glass
    int glass;           // its row among the materials; -1 - the row of its film among the albedos
    int turns;           // steps of a quarter turn between the albedos of facets; 0: facets are alike all round
    float even_base;     // 1 over the share of even light that dielectric facets leave
};

// Directional albedos of facets, which scatter once: at both ends of a step of the root of the cosine. The two numbers
// of rough glass are for light from outside and from inside; those of gloss are the factors of f0 and f90.
// Rows after them hold thin films, sheen and what a base lets through: bsdfs/iridescence.glsl, bsdfs/sheen.glsl,
// bsdfs/translucency.glsl.
struct Albedo {
    float one;
    float other;
    float one_end;
    float other_end;
};
