// A ray against all shapes. There are no offsets and no tolerances, so a scene scaled by a power of two
// gives the same bits.

// Whether the rounds of a sample are a guess (glrt/rendering/schedule.py): a dispatch may lose samples, and reports it.
const bool MAY_LOSE = HAS_SPHERE_TREE || HAS_TREE || HAS_MESH || HAS_HOLE || HAS_RANKS || HAS_GRID;

const bool SPHERES_BY_TREE = HAS_SPHERE_TREE && !SHAPES_ARE_CONSTANT;

// The nearer one of a hit and that of shape i of its kind. Shapes are tried in the order of their numbers: of two at the
// same distance, the first stays.

Hit with_sphere(Ray ray, Sphere sphere, int i, Hit hit, int ignored) {
    float t = sphere_distance(ray, sphere, i);
    return t > 0.0 && t < hit.distance && i != ignored ? Hit(t, i) : hit;
}

Hit with_plane(Ray ray, Plane plane, int i, Hit hit) {
    int shape = first_plane() + i;
    float t = plane_distance(ray, plane.point, plane.normal);
    return t > 0.0 && is_nearer(ray, t, shape, hit) && shape != ray.origin_shape ? Hit(t, shape) : hit;
}

Hit with_quad(Ray ray, Quad quad, int i, Hit hit, int ignored) {
    int shape = first_quad() + i;
    float t = quad_distance(ray, quad);
    bool is_met = t > 0.0 && is_nearer(ray, t, shape, hit) && shape != ray.origin_shape && shape != ignored;
    return is_met ? Hit(t, shape) : hit;
}

Hit with_disk(Ray ray, Disk disk, int i, Hit hit, int ignored) {
    int shape = first_disk() + i;
    float t = disk_distance(ray, disk);
    bool is_met = t > 0.0 && is_nearer(ray, t, shape, hit) && shape != ray.origin_shape && shape != ignored;
    return is_met ? Hit(t, shape) : hit;
}

Hit with_box(Ray ray, Box box, int i, Hit hit) {
    int shape = first_box() + i;
    float t = box_distance(ray, box, shape);
    return t > 0.0 && is_nearer(ray, t, shape, hit) ? Hit(t, shape) : hit;
}

Hit with_cylinder(Ray ray, Cylinder cylinder, int i, Hit hit) {
    int shape = first_cylinder() + i;
    float t = cylinder_distance(ray, cylinder, shape);
    return t > 0.0 && is_nearer(ray, t, shape, hit) ? Hit(t, shape) : hit;
}

// The nearest of the shapes that no tree has, if it is nearer than hit.distance. An early exit where any hit will do
// takes longer than the tests that it saves (llvmpipe: a tenth of all time, where shapes are read).
Hit find_in_loops(Ray ray, Hit hit, int ignored) {
    int i = 0;
    if (HAS_SPHERE && !BY_TREE && !SPHERES_BY_TREE) {
        for (i = 0; i < sphere_first_count(); ++i) hit = with_sphere(ray, sphere_of_first(i), i, hit, ignored);
        note_end(i, sphere_first_count());
        if (HAS_SECOND_LOOP) {
            for (i = 0; i < sphere_second_count(); ++i) {
                hit = with_sphere(ray, sphere_of_second(i), LOOP + i, hit, ignored);
            }
            note_end(i, sphere_second_count());
        }
    }
    if (HAS_PLANE) {
        for (i = 0; i < plane_first_count(); ++i) hit = with_plane(ray, plane_of_first(i), i, hit);
        note_end(i, plane_first_count());
        if (HAS_SECOND_LOOP) {
            for (i = 0; i < plane_second_count(); ++i) hit = with_plane(ray, plane_of_second(i), LOOP + i, hit);
            note_end(i, plane_second_count());
        }
    }
    if (HAS_QUAD && !BY_TREE) {
        for (i = 0; i < quad_first_count(); ++i) hit = with_quad(ray, quad_of_first(i), i, hit, ignored);
        note_end(i, quad_first_count());
        if (HAS_SECOND_LOOP) {
            for (i = 0; i < quad_second_count(); ++i) hit = with_quad(ray, quad_of_second(i), LOOP + i, hit, ignored);
            note_end(i, quad_second_count());
        }
    }
    if (HAS_DISK && !BY_TREE) {
        for (i = 0; i < disk_first_count(); ++i) hit = with_disk(ray, disk_of_first(i), i, hit, ignored);
        note_end(i, disk_first_count());
        if (HAS_SECOND_LOOP) {
            for (i = 0; i < disk_second_count(); ++i) hit = with_disk(ray, disk_of_second(i), LOOP + i, hit, ignored);
            note_end(i, disk_second_count());
        }
    }
    if (HAS_BOX && !BY_TREE) {
        for (i = 0; i < box_first_count(); ++i) hit = with_box(ray, box_of_first(i), i, hit);
        note_end(i, box_first_count());
        if (HAS_SECOND_LOOP) {
            for (i = 0; i < box_second_count(); ++i) hit = with_box(ray, box_of_second(i), LOOP + i, hit);
            note_end(i, box_second_count());
        }
    }
    if (HAS_CYLINDER && !BY_TREE) {
        for (i = 0; i < cylinder_first_count(); ++i) hit = with_cylinder(ray, cylinder_of_first(i), i, hit);
        note_end(i, cylinder_first_count());
        if (HAS_SECOND_LOOP) {
            for (i = 0; i < cylinder_second_count(); ++i) {
                hit = with_cylinder(ray, cylinder_of_second(i), LOOP + i, hit);
            }
            note_end(i, cylinder_second_count());
        }
    }
    return hit;  // of all kinds
}

// The nearest shape nearer than `limit`, apart from the shape `ignored`. If two shapes are at the same distance, it is
// the one with the lower number, or the one that comes first by shapes/coincident.glsl. With `any`, it is any of them.
Hit find_hit(Ray ray, float limit, int ignored, bool any) {
    Hit hit = Hit(limit, NO_SHAPE);
    if (HAS_COINCIDENT) ray = clear_of(ray);
    if (SPHERES_BY_TREE) hit = find_sphere_by_tree(ray, hit, ignored, any);
    hit = find_in_loops(ray, hit, ignored);
    if (BY_TREE || HAS_MESH) hit = find_by_tree(ray, hit, ignored, any);
    return hit;
}

float rays_so_far = 0.0;  // of this sample, where COUNT_RAYS

Hit closest_hit(Ray ray) {
    if (COUNT_RAYS) rays_so_far += 1.0;
    return find_hit(ray, FAR, NO_SHAPE, false);
}
