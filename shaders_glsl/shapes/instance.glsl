// Meshes in trees of their own: their triangles are stored once, however often they are placed. An instance is one
// place of such a mesh. The number of a triangle there contains the number of its instance, from 1 on, in the bits from
// INSTANCE_BITS on, and its place in the mesh below; 0 stands for the triangles in the tree of the scene.

int first_triangle() { return first_mesh() + mesh_count(); }

bool is_triangle(int shape) { return HAS_MESH && shape >= first_triangle(); }

int instance_of(int shape) { return HAS_INSTANCE ? (shape - first_triangle()) >> INSTANCE_BITS : 0; }

Triangle triangle_of(int shape) {
    int number = shape - first_triangle();
    if (HAS_INSTANCE) {
        int instance = number >> INSTANCE_BITS;
        number &= (1 << INSTANCE_BITS) - 1;
        if (instance > 0) number += instance_at(instance - 1).triangles;
    }
    return triangle_at(number);
}

// From the scene to the frame of a mesh. The unit of the frame is a cell of the grid of the mesh's tree.
struct Inward {
    vec3 to_x;  // dot product with a vector: its x in the frame
    vec3 to_y;
    vec3 to_z;
    vec3 origin;  // of the frame, relative to the middle of the tree
    float reach;  // from the middle of the tree to the farthest corner, at most
};

Inward inward_of(Instance instance) {
    return Inward(instance.to_x, instance.to_y, instance.to_z, instance.origin, instance.reach);
}

// The same, from a leaf as the packer writes it: glrt/packing/instances.py.
Inward inward_at(Slot slot) {
    vec4 a = uintBitsToFloat(slot.a);
    vec4 b = uintBitsToFloat(slot.b);
    vec4 c = uintBitsToFloat(slot.c);
    return Inward(a.xyz, vec3(a.w, b.xy), vec3(b.zw, c.x), c.yzw, uintBitsToFloat(slot.d.z));
}

// A vector of the scene in the frame of a mesh. Distances along a ray stay those of the scene.
vec3 turned_in(Inward inward, vec3 v) {
    vec3 turned = vec3(dot(inward.to_x, v), dot(inward.to_y, v), dot(inward.to_z, v));
    return turned;
}

// A vector perpendicular to a surface, from the frame of a mesh to the scene.
vec3 facing_of(Instance instance, vec3 normal) {
    vec3 facing = normal.x * instance.to_x + normal.y * instance.to_y + normal.z * instance.to_z;
    return facing;
}

// A point given in the frame of a mesh, relative to the middle of the tree.
vec3 place_of(Instance instance, vec3 point) {
    vec3 place = instance.origin + point.x * instance.from_x + point.y * instance.from_y
                       + point.z * instance.from_z;
    return place;
}
