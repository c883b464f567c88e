// Media: fog, smoke and glowing gas, which scatter, absorb and emit light between surfaces.

const int NO_MEDIUM = -1;  // vacuum

const int NO_GRID = -1;  // the same density everywhere

// Coefficients per unit of length, where the density is 1.
struct Medium {
    vec3 scattering;
    float anisotropy;  // mean cosine of the angle by which light turns
    vec3 extinction;   // scattering and absorption
    int layer;         // of the light group of its emission
    vec3 emission;     // radiance per unit of length
    int grid;          // row of a grid, or NO_GRID
};

// Densities of a medium. A place has the coordinates dot(x, place) + at_x and so on, in voxels from the lowest corner
// of the grid's box.
struct Grid {
    vec3 x;
    float at_x;
    vec3 y;
    float at_y;
    vec3 z;
    float at_z;
    ivec3 size;       // voxels
    int first;        // number of its first texel
    int first_brick;  // number of the texel with the largest density of its first brick
    float top;        // density of a texel with the value 1
    float least;      // extinction of the fictitious medium that collides, per density, at least: for emission
    int spare;
};

// The bounds of a volume: an object, and the media on both sides of its surface.
struct Boundary {
    int object;   // kernel's number
    int inside;   // row of a medium, or NO_MEDIUM
    int outside;
    int spare;
};
