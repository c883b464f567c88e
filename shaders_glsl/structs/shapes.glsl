// Shapes, numbered consecutively by kind (glrt/packing/shapes.py has the order). Positions are in scene units, relative
// to the camera; axes are those of the world.

const int NO_SHAPE = -1;

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
    float shear;  // component of edge_u along edge_v
    vec3 dual_v;
};

struct Disk {
    vec3 center;
    int material;
    vec3 normal;  // unit
    float radius;
    int light;
};

struct Box {
    vec3 center;
    int material;
    vec3 axis_x;  // unit
    float half_x;
    vec3 axis_y;
    float half_y;
    vec3 axis_z;
    float half_z;
};

struct Cylinder {
    vec3 center;  // halfway between its ends
    int material;
    vec3 axis;    // unit
    float radius;
    float half_height;
    int is_capped;
};

struct Mesh {
    int material;
    int is_smooth;  // whether normals are interpolated
    int spare_a;    // fill the row
    int spare_b;
};

// A corner of meshes, relative to the middle of the tree over shapes.
struct Corner {
    vec3 position;
    uint normal;  // unit, on an octahedron: see unpacked_normal
};

// Colour of a corner, where some mesh has colours of its own.
struct Tint {
    vec3 color;  // linear; factor of the material's colour
    int spare;   // fills the row
};

struct Triangle {
    ivec3 corners;
    uint owner;   // its mesh; from bit 16 on its light + 1, or 0
    vec3 normal;  // unit; outwards where the mesh encloses a volume
    float reach;  // largest absolute coordinate of its corners
};

// A place of a mesh that has a tree of its own: maps from the scene to the frame of the mesh, and back. The unit of the
// frame is a cell of the grid of that tree.
struct Instance {
    vec3 to_x;  // dot product with a vector: its x in the frame
    int mesh;
    vec3 to_y;
    int triangles;  // row of the first triangle of the mesh
    vec3 to_z;
    float reach;  // from the middle of the tree over shapes to the farthest corner, at most
    vec3 origin;  // of the frame, relative to the middle of the tree over shapes
    int spare_a;  // fill rows
    vec3 from_x;  // unit vector of the frame in the scene
    int spare_b;
    vec3 from_y;
    int spare_c;
    vec3 from_z;
    int spare_d;
};

// A node of the tree over the spheres: one sphere, and a box around all spheres below it. It is packed, because reading
// a node costs more than unpacking it. The first row is not a node, but the grid of the boxes.
struct Node {
    uvec4 sphere;  // bits of centre and radius; for the grid: its corner, and the edge of a cell
    uvec4 box;     // along each axis its end << 16 | its start, in cells; nodes below << 16 | sphere
};

// A slot of the tree over the other shapes: a node of 8 children, or a leaf. glrt/accel/wide_tree.py describes its
// words.
struct Slot {
    uvec4 a;
    uvec4 b;
    uvec4 c;
    uvec4 d;
};

// Kinds of leaves.
const int INSTANCE = 0;   // a mesh with a tree of its own: see glrt/packing/instances.py
const int SPHERE = 1;
const int QUAD = 2;
const int DISK = 3;
const int BOX = 4;
const int CYLINDER = 5;
const int TRIANGLES = 7;  // two triangles of a mesh: see glrt/packing/triangles.py
