// Media: fog, smoke and glowing gas, which scatter, absorb and emit light between surfaces.

const int NO_MEDIUM = -1;  // vacuum

// Coefficients per unit of length. Without a spare, a row would end in the middle of four words.
struct Medium {
    vec3 scattering;
    float anisotropy;  // mean cosine of the angle by which light turns
    vec3 extinction;   // scattering and absorption
    int layer;         // of the light group of its emission
    vec3 emission;     // radiance per unit of length
    int spare;
};

// The bounds of a volume: an object, and the media on both sides of its surface.
struct Boundary {
    int object;   // kernel's number
    int inside;   // row of a medium, or NO_MEDIUM
    int outside;
    int spare;
};
