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

// Directional albedo of the facets of rough glass, which scatter once: at both ends of a step of the
// root of the cosine.
struct Albedo {
    float outer;  // of light from outside
    float inner;
    float outer_end;
    float inner_end;
};
