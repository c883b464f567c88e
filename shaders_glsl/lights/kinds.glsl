// Kinds of lamps that are sampled. LAMP_KINDS: how many of them the scene has.
//
// A function that distinguishes kinds asks for them in this order: sphere, triangle, disk, quad. So a test that the
// earlier ones have decided is left out. Where the scene has a kind that is not among these, each kind is tested, and
// a shape of an unknown kind is no lamp.

const int KNOWN_KINDS =
    int(HAS_SPHERE_LIGHT) + int(HAS_MESH_LIGHT) + int(HAS_DISK_LIGHT) + int(HAS_QUAD_LIGHT);
const bool HAS_OTHER_LIGHT = LAMP_KINDS > KNOWN_KINDS;

bool is_sphere_lamp(int shape) {
    bool is_alone = !(HAS_MESH_LIGHT || HAS_DISK_LIGHT || HAS_QUAD_LIGHT || HAS_OTHER_LIGHT);
    return HAS_SPHERE_LIGHT && (is_alone || up_to_sphere(shape));
}

bool is_triangle_lamp(int shape) {
    bool is_last = !(HAS_DISK_LIGHT || HAS_QUAD_LIGHT || HAS_OTHER_LIGHT);
    return HAS_MESH_LIGHT && (is_last || is_triangle(shape));
}

bool is_disk_lamp(int shape) {
    bool is_last = !(HAS_QUAD_LIGHT || HAS_OTHER_LIGHT);
    return HAS_DISK_LIGHT && (is_last || is_disk(shape));
}

bool is_quad_lamp(int shape) {
    return HAS_QUAD_LIGHT && (!HAS_OTHER_LIGHT || is_quad(shape));
}

Disk disk_lamp(int shape) {
    return disk_at(shape - first_disk());
}

Quad quad_lamp(int shape) {
    return quad_at(shape - first_quad());
}
