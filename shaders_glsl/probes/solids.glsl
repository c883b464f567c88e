// Where probes should not stand.

// Whether a ray in a direction meets this surface from within a solid: a sphere, a box or a cylinder with caps that the
// camera is not in. Rooms may be built of them, too; then the camera is inside. Of all else both sides are outside.
bool is_inner_face(int shape, vec3 normal, vec3 direction) {
    if (dot(direction, normal) <= 0.0) return false;
    if (HAS_SPHERE && up_to_sphere(shape)) {
        precise Sphere sphere = sphere_at(shape);
        return dot(sphere.center, sphere.center) > sphere.radius * sphere.radius;
    }
    if (HAS_PLANE && up_to_plane(shape)) return false;
    if (HAS_QUAD && up_to_quad(shape)) return false;
    if (HAS_DISK && up_to_disk(shape)) return false;
    if (HAS_BOX && up_to_box(shape)) {
        precise Box box = box_at(shape - first_box());
        precise vec3 eye = abs(along_edges(box, box.center));
        return any(greaterThan(eye, vec3(box.half_x, box.half_y, box.half_z)));
    }
    if (HAS_CYLINDER && up_to_cylinder(shape)) {
        precise Cylinder cylinder = cylinder_at(shape - first_cylinder());
        precise float height = dot(cylinder.center, cylinder.axis);
        precise float beside = length(cylinder.center - height * cylinder.axis);
        return cylinder.is_capped != 0 && (abs(height) > cylinder.half_height || beside > cylinder.radius);
    }
    return false;
}
