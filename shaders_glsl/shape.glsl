// Rays against spheres, planes and quads. No offsets and no tolerances: a ray knows the shape
// that it leaves. A flat shape is not hit again; a sphere is hit again only from inside, at the
// far end of its chord. So a scene scaled by a power of two gives the same bits.
//
// The entry file supplies sphere_at, sphere_count, and so on for planes and quads.

const float FAR = 3.402823466e38;

struct Hit {
    float distance;
    int shape;
};

struct Surface {
    vec3 position;
    vec3 normal;   // unit; outward on a sphere, else the shape's own
    int shape;
    int material;
    int light;
};

// The distance along the ray, not above 0 for a miss. The form of Haines et al. ("Precision
// Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019): the discriminant keeps the
// digits of r^2 from afar, and neither root is a difference of near equals.
float sphere_distance(Ray ray, Sphere sphere, int shape) {
    vec3 to_center = sphere.center - ray.origin;
    float along = dot(to_center, ray.direction);
    vec3 beside = to_center - along * ray.direction;
    float r2 = sphere.radius * sphere.radius;
    float discriminant = r2 - dot(beside, beside);
    if (shape == ray.leaves) {
        float chord = 2.0 * along;  // twice the way to its middle: along the rim, roots are all noise
        return ray.inward ? chord : 0.0;
    }
    if (discriminant <= 0.0) return 0.0;
    float half_chord = sqrt(discriminant);
    float q = along >= 0.0 ? along + half_chord : along - half_chord;
    float c = dot(to_center, to_center) - r2;
    float t = c / q;
    return t > 0.0 ? t : q;
}

// Infinite or NaN for a parallel ray: no comparison below lets that pass.
float plane_distance(Ray ray, vec3 point, vec3 normal) {
    float height = dot(point - ray.origin, normal);
    float approach = dot(ray.direction, normal);
    float t = height / approach;
    return t;
}

float quad_distance(Ray ray, Quad quad) {
    float t = plane_distance(ray, quad.corner, quad.normal);
    vec3 p = ray.origin + t * ray.direction - quad.corner;
    float u = dot(quad.dual_u, p);
    float v = dot(quad.dual_v, p);
    bool inside = u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0;
    return inside ? t : 0.0;
}

// Some drivers end loops early, silently (glrt/gpu/driver_checks.py); see add_samples.
bool loop_was_cut = false;

void note_end(int reached, int end) {
    if (reached < end) loop_was_cut = true;
}

Hit find_sphere(Ray ray, Hit hit, int ignored, bool any);  // in bvh.glsl

// The nearest shape nearer than `limit`, apart from the shape `ignored`; of two at the same
// distance the one with the lower number. With `any`, the first that is found.
Hit find_hit(Ray ray, float limit, int ignored, bool any) {
    Hit hit = Hit(limit, NO_SHAPE);
    if (HAS_TREE) {
        hit = find_sphere(ray, hit, ignored, any);
        if (any && hit.shape != NO_SHAPE) return hit;
    } else if (HAS_SPHERE) {
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
            int shape = sphere_count() + i;
            Plane plane = plane_at(i);
            float t = plane_distance(ray, plane.point, plane.normal);
            if (t > 0.0 && t < hit.distance && shape != ray.leaves) {
                hit = Hit(t, shape);
                if (any) return hit;
            }
        }
        note_end(i, plane_count());
    }
    if (HAS_QUAD) {
        int i = 0;
        for (; i < quad_count(); ++i) {
            int shape = sphere_count() + plane_count() + i;
            float t = quad_distance(ray, quad_at(i));
            if (t > 0.0 && t < hit.distance && shape != ray.leaves && shape != ignored) {
                hit = Hit(t, shape);
                if (any) return hit;
            }
        }
        note_end(i, quad_count());
    }
    return hit;
}

Hit closest_hit(Ray ray) {
    return find_hit(ray, FAR, NO_SHAPE, false);
}

// Whether anything but the lamp `ignored` stands within `limit`.
bool occluded(Ray ray, float limit, int ignored) {
    return find_hit(ray, limit, ignored, true).shape != NO_SHAPE;
}

// The point hit, put back onto the shape: the distance alone leaves it beside.
Surface surface_at(Ray ray, Hit hit) {
    vec3 p = ray.origin + hit.distance * ray.direction;
    int flat_index = hit.shape - sphere_count();
    if (HAS_SPHERE && (flat_index < 0 || !(HAS_PLANE || HAS_QUAD))) {
        Sphere sphere = sphere_at(hit.shape);
        vec3 normal = normalized(p - sphere.center);
        vec3 position = sphere.center + sphere.radius * normal;
        return Surface(position, normal, hit.shape, sphere.material, sphere.light);
    }
    if (HAS_PLANE && (!HAS_QUAD || flat_index < plane_count())) {
        Plane plane = plane_at(flat_index);
        vec3 position = p - dot(p - plane.point, plane.normal) * plane.normal;
        return Surface(position, plane.normal, hit.shape, plane.material, NO_LIGHT);
    }
    Quad quad = quad_at(flat_index - plane_count());
    vec3 position = p - dot(p - quad.corner, quad.normal) * quad.normal;
    return Surface(position, quad.normal, hit.shape, quad.material, quad.light);
}
