// Images on surfaces.

const int NO_MAP = -1;
const int REPEAT = 0;  // beyond its edges the image starts again
const int MIRROR = 1;  // the image starts again, mirrored
const int CLAMP = 2;   // the colour of its edge goes on
const int ALL_CHANNELS = -1;

struct Map {
    vec3 u;           // dot product with (u, v, 1): place along the width, in widths
    int first;        // number of its first texel
    vec3 v;           // the same along the height
    int width;        // texels
    int height;
    int wrap_u;       // REPEAT, MIRROR or CLAMP
    int is_sharp;     // whether its texels are not interpolated
    int channel;      // the channel that is used, or ALL_CHANNELS
    int set;          // number of the texture coordinates, 0 or 1
    float strength;   // of normals
    int wrap_v;
    int spare;        // fills the row
};

// Maps of a material: their numbers, or NO_MAP.
struct Maps {
    int color;
    int emission;
    int normal;
    int metallic;
    int roughness;
    int coverage;
    float cutoff;   // surface from this coverage on; below 0: the surface is partly there
    int crossed;
};

// Texture coordinates on flat shapes. Rows are numbered from the first plane on.
struct Axes {
    vec3 origin;  // where the coordinates are 0, relative to the camera
    int spare_a;  // fill rows
    vec3 u;       // dot product with a vector: what it adds to u
    int spare_b;
    vec3 v;
    int spare_c;
};

// Texture coordinates of a corner of a triangle.
struct Uv {
    vec2 first;
    vec2 second;
};

// Tangent of a corner: where u of the first texture coordinates grows.
struct Tangent {
    vec3 along;  // in the frame of the mesh, or of the scene like the normal; 0: none
    int spare;   // fills the row
};
