// Rays against boxes, along the edges of each. A box is convex. A ray that leaves it outwards never meets it
// again; a ray that runs inwards ends at the first face that it runs towards.

// The smallest normal number: a way of no length. By rounding, a ray that runs inwards from an edge may start
// beyond the next face. It still ends there, so that no ray leaves the box unseen. To move a point by this
// distance does not change it.
const float NO_WAY = 1.17549435e-38;

// Distances where a ray crosses the faces of a box: `first` at the faces that it meets from outside, `last` at
// the faces that it runs towards from inside.
struct BoxCrossing {
    vec3 direction;  // along the edges
    vec3 first;
    vec3 last;
    float enters;
    float leaves;
};

vec3 along_edges(Box box, vec3 v) {
    vec3 local = vec3(dot(box.axis_x, v), dot(box.axis_y, v), dot(box.axis_z, v));
    return local;
}

// A ray parallel to a pair of faces is between them everywhere or nowhere.
vec2 between_faces(float origin, float direction, float half_size) {
    if (direction == 0.0) return vec2(abs(origin) <= half_size ? -FAR : FAR, FAR);
    float ahead = direction < 0.0 ? -half_size : half_size;
    vec2 times = vec2(-ahead - origin, ahead - origin) / direction;
    return times;
}

BoxCrossing cross_box(Ray ray, Box box) {
    vec3 origin = along_edges(box, ray.origin - box.center);
    vec3 direction = along_edges(box, ray.direction);
    vec2 x = between_faces(origin.x, direction.x, box.half_x);
    vec2 y = between_faces(origin.y, direction.y, box.half_y);
    vec2 z = between_faces(origin.z, direction.z, box.half_z);
    float enters = larger(larger(x.x, y.x), z.x);
    float leaves = lesser(lesser(x.y, y.y), z.y);
    return BoxCrossing(direction, vec3(x.x, y.x, z.x), vec3(x.y, y.y, z.y), enters, leaves);
}

float box_distance(Ray ray, Box box, int shape) {
    BoxCrossing crossing = cross_box(ray, box);
    if (shape == ray.origin_shape) return ray.inward ? larger(crossing.leaves, NO_WAY) : 0.0;
    if (crossing.enters > crossing.leaves) return 0.0;
    return crossing.enters > 0.0 ? crossing.enters : crossing.leaves;
}

// The ray decides which face it has met, and not the point: at an edge, only this keeps to the ray's side.
Surface box_surface(Ray ray, vec3 p, int shape) {
    Box box = box_at(shape - first_box());
    BoxCrossing crossing = cross_box(ray, box);
    bool inside = shape == ray.origin_shape || crossing.enters <= 0.0;
    vec3 times = inside ? crossing.last : crossing.first;
    float time = inside ? crossing.leaves : crossing.enters;
    vec4 face = vec4(box.axis_z, box.half_z);
    float along = crossing.direction.z;
    if (times.y == time) {
        face = vec4(box.axis_y, box.half_y);
        along = crossing.direction.y;
    }
    if (times.x == time) {
        face = vec4(box.axis_x, box.half_x);
        along = crossing.direction.x;
    }
    vec3 normal = (along < 0.0) == inside ? -face.xyz : face.xyz;
    vec3 position = p - (dot(p - box.center, normal) - face.w) * normal;
    return Surface(position, normal, shape, box.material, NO_LIGHT);
}
