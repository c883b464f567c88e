// Kinds of lamps that are sampled. LAMP_KINDS: how many of them the scene has; a single kind needs no test.
// A function that distinguishes kinds names each one. A shape of no known kind is not a lamp there.

bool is_sphere_lamp(int shape) {
    return HAS_SPHERE_LIGHT && (LAMP_KINDS == 1 || up_to_sphere(shape));
}

bool is_quad_lamp(int shape) {
    return HAS_QUAD_LIGHT && (LAMP_KINDS == 1 || is_quad(shape));
}

bool is_disk_lamp(int shape) {
    return HAS_DISK_LIGHT && (LAMP_KINDS == 1 || is_disk(shape));
}

bool is_triangle_lamp(int shape) {
    return HAS_MESH_LIGHT && (LAMP_KINDS == 1 || is_triangle(shape));
}

Quad quad_lamp(int shape) {
    return quad_at(shape - first_quad());
}

Disk disk_lamp(int shape) {
    return disk_at(shape - first_disk());
}
