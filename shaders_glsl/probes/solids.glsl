// Places where probes should not stand.

// Solids are spheres, boxes and cylinders with caps. Both sides of all other shapes are outside.
bool is_solid(int shape) {
    if (HAS_SPHERE && up_to_sphere(shape)) return true;
    if (HAS_PLANE && up_to_plane(shape)) return false;
    if (HAS_QUAD && up_to_quad(shape)) return false;
    if (HAS_DISK && up_to_disk(shape)) return false;
    if (HAS_BOX && up_to_box(shape)) return true;
    return HAS_CYLINDER && up_to_cylinder(shape) && cylinder_at(shape - first_cylinder()).is_capped != 0;
}

// Whether the camera is in a solid: then the solid is a room.
bool holds_camera(int shape) {
    if (HAS_SPHERE && up_to_sphere(shape)) {
        Sphere sphere = sphere_at(shape);
        return dot(sphere.center, sphere.center) <= sphere.radius * sphere.radius;
    }
    if (HAS_BOX && up_to_box(shape)) {
        Box box = box_at(shape - first_box());
        vec3 eye = abs(along_edges(box, box.center));
        return all(lessThanEqual(eye, vec3(box.half_x, box.half_y, box.half_z)));
    }
    Cylinder cylinder = cylinder_at(shape - first_cylinder());
    float height = dot(cylinder.center, cylinder.axis);
    float beside = length(cylinder.center - height * cylinder.axis);
    return abs(height) <= cylinder.half_height && beside <= cylinder.radius;
}

// Whether a ray in a direction meets the side of a solid on which the camera does not lie.
bool is_wrong_face(int shape, vec3 normal, vec3 direction) {
    if (!is_solid(shape)) return false;
    bool from_inside = dot(direction, normal) > 0.0;
    return from_inside != holds_camera(shape);
}
