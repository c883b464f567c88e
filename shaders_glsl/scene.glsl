// The structs that host and kernels share. The host reads this very file (glrt/gpu/structs.py), so a
// field is declared once, here. Rows of four words: std140 and std430 then agree, and the same
// array can lie in a uniform block or in a storage block.
//
// Positions are in scene units, relative to the camera; axes are those of the world.
// Colours are linear sRGB. Shapes are numbered through: spheres, then planes, then quads.

const int NO_SHAPE = -1;
const int NO_LIGHT = -1;
const int SEVERAL = -2;  // no shape either

const int PARTS = 8;  // of a cluster, among many lamps

const int MATTE = 0;       // Lambert's law; lamps are of this kind too
const int METAL = 1;       // mirror or GGX
const int DIELECTRIC = 2;  // smooth interface with Fresnel reflection

struct Sphere {
    vec3 center;
    float radius;
    int material;
    int light;  // index into the lights, or NO_LIGHT
};

struct Plane {
    vec3 point;
    int material;
    vec3 normal;  // unit
};

struct Quad {
    vec3 corner;
    int material;
    vec3 normal;  // unit, along cross(edge_u, edge_v)
    int light;
    vec3 edge_u;  // the shorter edge
    float width;  // across edge_v
    vec3 edge_v;
    float height;
    vec3 dual_u;  // dot(dual_u, p - corner) is 0 at the corner, 1 at the end of edge_u
    float shear;  // of edge_u, along edge_v
    vec3 dual_v;
};

// Of the tree over the spheres: one of them, and a box around all that lie below it. Packed: to read a
// node costs more than to take it apart. The first is no node, but the grid on which boxes lie.
struct Node {
    uvec4 sphere;  // bits of centre and radius; of the grid: its corner, and the edge of a cell
    uvec4 box;     // along each axis its end << 16 | its start, in cells; nodes below << 16 | sphere
};

struct Material {
    vec3 color;      // albedo or reflectance
    int kind;        // MATTE, METAL or DIELECTRIC
    vec3 emission;   // radiance, light intensity included
    float alpha;     // GGX roughness, the square of the scene file's; 0: mirror
    float ior;       // inside over outside
    int layer;       // of its light group, where light is kept by layers
};

struct Light {
    int shape;
    float share;  // of the flux of its part
    float keep;   // alias method: this light with probability `keep`, else its alias
    int alias;    // its part, an index into the clusters, << 16 | its alias
};

// Lamps close together. Of few lamps each is a cluster; the clusters of many are followed by PARTS
// of each, those of the first one first. A part holds the lamps from `first` on, or none.
struct Cluster {
    vec3 center;        // mean place of their flux
    float reach2;       // mean squared distance of their points from the center
    float probability;  // their share of all flux
    int first;
    int count;
    int shape;          // of the lamp if it is one, else SEVERAL
};

struct Camera {
    vec3 right;     // unit
    float tan_x;    // half the width of the image plane at distance 1
    vec3 up;        // unit
    float tan_y;
    vec3 forward;   // unit
    float lens_radius;
    float tan_lens; // lens radius over focus distance
};

struct Frame {
    Camera camera;
    vec3 background_bottom;  // radiance from below and from above
    int bounces;             // scattering events on a path
    vec3 background_top;
    uint seed;
    ivec2 size;              // of the full frame, pixels
    ivec2 origin;            // of the crop in it
    int first_sample;        // how many samples each pixel has
    int sample_count;        // how many this dispatch adds
    int sphere_count;
    int plane_count;
    int quad_count;
    int light_count;
    int first_tile;         // of this dispatch: see tiles.glsl
    int tile_stride;
    int node_count;
};
