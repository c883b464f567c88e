// Media: fog, smoke and glowing gas, which scatter, absorb and emit light between surfaces.

const int NO_MEDIUM = -1;  // vacuum

// Coefficients per unit of length, where the density is 1. A place has the coordinates dot(x, place) + at_x and so on in
// a grid of densities, in voxels from the lowest corner of its box.
struct Medium {
    vec3 scattering;
    float anisotropy;  // mean cosine of the angle by which light turns
    vec3 extinction;   // scattering and absorption
    int layer;         // of the light group of its emission
    vec3 emission;     // radiance per unit of length
    float top;         // density of a voxel with the value 1
    vec3 x;
    float at_x;
    vec3 y;
    float at_y;
    vec3 z;
    float at_z;
    ivec3 size;        // voxels; 0: no grid, the density is 1 everywhere
    int first;         // number of the first texel of its voxels, then of the bounds of its bricks
};

// The bounds of a volume: an object, and the media on both sides of its surface.
struct Boundary {
    int object;   // kernel's number
    int inside;   // row of a medium, or NO_MEDIUM
    int outside;
    float ior;    // of its glass, against air, where HAS_RANKS; 0: it is not of glass
};
