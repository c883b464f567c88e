// Flat surfaces in one place, where one of them emits: a lamp in the plane of a ceiling, or two lamps that overlap. A
// place has one surface, and every ray sees the same one. Among surfaces that a ray meets within rounding of each
// other, one that emits towards the ray comes before others, these before bounds of volumes, then the one with the
// lower number. HAS_COINCIDENT:
// whether there are such places (glrt/scene/coincidence.py).

// Shares of the largest coordinate: 2^-19 and 2^-18, 32 and 64 times the rounding of a float. Two tests of a flat
// shape round by 16 times each, and a ray starts 32 times off the surface that it leaves.
const float APART = 2.0 * CLEARANCE;
const float TOGETHER = 4.0 * CLEARANCE;
const float STEEP = 3.90625e-3;  // 2^-8, a cosine: below it a ray runs nearly along surfaces, which do not tie

float coincident_reach(Ray ray) {
    vec3 size = abs(ray.origin);
    float reach = larger(frame.coincident_reach, larger(larger(size.x, size.y), size.z));
    return reach;
}

vec3 box_face_at(Box box, vec3 place) {
    vec3 beyond = abs(along_edges(box, place - box.center)) - vec3(box.half_x, box.half_y, box.half_z);
    if (beyond.x >= beyond.y && beyond.x >= beyond.z) return box.axis_x;
    return beyond.y >= beyond.z ? box.axis_y : box.axis_z;
}

// The normal of the flat surface that a ray starts on, of either sign; 0 if that is round, and without a surface.
vec3 normal_left(Ray ray, float reach) {
    int shape = ray.origin_shape;
    if (shape == NO_SHAPE || (HAS_SPHERE && up_to_sphere(shape))) return vec3(0.0);
    if (HAS_BOX && is_box(shape)) {
        vec3 face = box_face_at(box_at(shape - first_box()), ray.origin);
        return face;
    }
    if (HAS_CYLINDER && is_cylinder(shape)) {
        Cylinder cylinder = cylinder_at(shape - first_cylinder());
        float height = abs(dot(ray.origin - cylinder.center, cylinder.axis));
        bool is_cap = height >= cylinder.half_height - APART * reach;
        return is_cap ? cylinder.axis : vec3(0.0);
    }
    vec3 normal = true_normal(surface_at(ray, Hit(0.0, shape)));
    return normal;
}

// The ray, with an origin clear of all surfaces in the place of the surface that it leaves.
Ray clear_of(Ray ray) {
    float reach = coincident_reach(ray);
    vec3 normal = normal_left(ray, reach);
    float shift = dot(normal, ray.direction) < 0.0 ? -APART * reach : APART * reach;
    ray.origin += shift * normal;
    return ray;
}

struct Claim {
    vec3 normal;
    int rank;  // 2: it emits towards the ray, 0: it only bounds a volume, 1: any other surface
};

Claim claim_of(Ray ray, float t, int shape) {
    Surface surface = surface_at(ray, Hit(t, shape));
    vec3 normal = true_normal(surface);
    Material material = material_at(surface.material);
    bool shines = material.emission != vec3(0.0);
    if (HAS_ONE_SIDED && emitter_at(material.emitter).is_one_sided != 0) {
        shines = shines && dot(normal, ray.direction) < 0.0;
    }
    return Claim(normal, shines ? 2 : HAS_NONE && material.kind == NONE ? 0 : 1);
}

// How far apart along a ray two hits may be that tie.
float tie_length(Ray ray) {
    float most = TOGETHER / STEEP * coincident_reach(ray);
    return most;
}

// Whether a ray that meets a shape at t sees this shape instead of the nearest hit so far.
bool comes_before(Ray ray, float t, int shape, Hit hit) {
    bool is_before = t < hit.distance;
    float apart = abs(t - hit.distance);
    // A loop, because llvmpipe runs the body of an `if` in any case, but leaves out a loop that no lane enters.
    int ties = t > 0.0 && apart <= tie_length(ray) && hit.shape != NO_SHAPE ? 1 : 0;
    for (int i = 0; i < ties; ++i) {
        Claim own = claim_of(ray, t, shape);
        Claim other = claim_of(ray, hit.distance, hit.shape);
        float cosine = larger(abs(dot(own.normal, ray.direction)), abs(dot(other.normal, ray.direction)));
        if (apart * cosine > TOGETHER * coincident_reach(ray)) continue;
        is_before = own.rank == other.rank ? shape < hit.shape : own.rank > other.rank;
    }
    return is_before;
}
