// Images on surfaces.

const int NO_MAP = -1;
const int REPEAT = 0;  // beyond its edges the image, again
const int MIRROR = 1;  // and again, mirrored
const int CLAMP = 2;   // or its edge
const int ALL_CHANNELS = -1;

struct Map {
    vec3 u;           // what to multiply (u, v, 1) by for the place along its width, in widths
    int first;        // of its texels
    vec3 v;           // the same along its height
    int width;        // texels
    int height;
    int wrap_u;       // REPEAT, MIRROR or CLAMP
    int is_sharp;     // whether its texels are not interpolated
    int channel;      // the one that counts, or ALL_CHANNELS
    int set;          // of the texture coordinates, 0 or 1
    float strength;   // of normals
    int wrap_v;
    int spare;        // fills the row
};

// Those of a material: numbers of maps, or NO_MAP.
struct Maps {
    int color;
    int emission;
    int normal;
    int metallic;
    int roughness;
    int coverage;
    float cutoff;   // coverage from which on the surface is there; below 0: there in part
    int crossed;
};

// How texture coordinates run over a flat shape, numbered from the first plane on.
struct Axes {
    vec3 origin;  // where they are 0, relative to the camera
    int spare_a;  // fill rows
    vec3 u;       // what to multiply a vector by for what it adds to them
    int spare_b;
    vec3 v;
    int spare_c;
};

// Texture coordinates of a corner of a triangle.
struct Uv {
    vec2 first;
    vec2 second;
};

// Where u of the first ones grows there.
struct Tangent {
    vec3 along;  // in the frame of the mesh, or of the scene as the normal; 0: nowhere
    int spare;   // fills the row
};
