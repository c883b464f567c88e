// A ray against all shapes. There are no offsets and no tolerances, so a scene scaled by a power of two
// gives the same bits.

// Whether the rounds of a sample are a guess (glrt/rendering/schedule.py): a dispatch may lose samples, and reports it.
const bool MAY_LOSE = HAS_SPHERE_TREE || HAS_TREE || HAS_MESH || HAS_HOLE || HAS_RANKS || HAS_GRID;

// The nearest disk, box or cylinder nearer than hit.distance, with the parameters of find_hit. Most scenes
// have none of these.
Hit find_among_others(Ray ray, Hit hit, int ignored, bool any) {
    if (HAS_DISK) {
        int i = 0;
        for (; i < disk_count(); ++i) {
            int shape = first_disk() + i;
            float t = disk_distance(ray, disk_at(i));
            if (t > 0.0 && is_nearer(ray, t, shape, hit) && shape != ray.origin_shape && shape != ignored) {
                hit = Hit(t, shape);
                if (any) return hit;
            }
        }
        note_end(i, disk_count());
    }
    if (HAS_BOX) {
        int i = 0;
        for (; i < box_count(); ++i) {
            int shape = first_box() + i;
            float t = box_distance(ray, box_at(i), shape);
            if (t > 0.0 && is_nearer(ray, t, shape, hit)) {
                hit = Hit(t, shape);
                if (any) return hit;
            }
        }
        note_end(i, box_count());
    }
    if (HAS_CYLINDER) {
        int i = 0;
        for (; i < cylinder_count(); ++i) {
            int shape = first_cylinder() + i;
            float t = cylinder_distance(ray, cylinder_at(i), shape);
            if (t > 0.0 && is_nearer(ray, t, shape, hit)) {
                hit = Hit(t, shape);
                if (any) return hit;
            }
        }
        note_end(i, cylinder_count());
    }
    return hit;
}

// The nearest shape nearer than `limit`, apart from the shape `ignored`. If two shapes are at the same distance, it is
// the one with the lower number, or the one that comes first by shapes/coincident.glsl. With `any`, it is the first
// that is found.
//
// The loops stand in one function: a function for each kind, with its early exit, costs 1 to 3 % on llvmpipe.
Hit find_hit(Ray ray, float limit, int ignored, bool any) {
    Hit hit = Hit(limit, NO_SHAPE);
    if (HAS_COINCIDENT) ray = clear_of(ray);
    if (HAS_SPHERE_TREE) {
        hit = find_sphere_by_tree(ray, hit, ignored, any);
        if (any && hit.shape != NO_SHAPE) return hit;
    } else if (HAS_SPHERE && !HAS_TREE) {
        int i = 0;
        for (; i < sphere_count(); ++i) {
            float t = sphere_distance(ray, sphere_at(i), i);
            if (t > 0.0 && t < hit.distance && i != ignored) {
                hit = Hit(t, i);
                if (any) return hit;
            }
        }
        note_end(i, sphere_count());
    }
    if (HAS_PLANE) {
        int i = 0;
        for (; i < plane_count(); ++i) {
            int shape = first_plane() + i;
            Plane plane = plane_at(i);
            float t = plane_distance(ray, plane.point, plane.normal);
            if (t > 0.0 && is_nearer(ray, t, shape, hit) && shape != ray.origin_shape) {
                hit = Hit(t, shape);
                if (any) return hit;
            }
        }
        note_end(i, plane_count());
    }
    if (HAS_QUAD && !HAS_TREE) {
        int i = 0;
        for (; i < quad_count(); ++i) {
            int shape = first_quad() + i;
            float t = quad_distance(ray, quad_at(i));
            if (t > 0.0 && is_nearer(ray, t, shape, hit) && shape != ray.origin_shape && shape != ignored) {
                hit = Hit(t, shape);
                if (any) return hit;
            }
        }
        note_end(i, quad_count());
    }
    if ((HAS_DISK || HAS_BOX || HAS_CYLINDER) && !HAS_TREE) hit = find_among_others(ray, hit, ignored, any);
    if (!HAS_TREE && !HAS_MESH) return hit;  // the nearest hit
    return find_by_tree(ray, hit, ignored, any);
}

float rays_so_far = 0.0;  // of this sample, where COUNT_RAYS

Hit closest_hit(Ray ray) {
    if (COUNT_RAYS) rays_so_far += 1.0;
    return find_hit(ray, FAR, NO_SHAPE, false);
}
