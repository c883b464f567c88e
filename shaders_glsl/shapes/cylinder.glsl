// Rays against cylinders. One with caps is convex, as a box is: a ray that leaves it outwards never meets it again, and
// one that runs inwards ends at the wall or at the end that it runs towards. One without caps is only a wall.

// Distances where a ray enters and leaves the wall, as if that were endless, and the space between the ends.
struct CylinderCrossing {
    vec2 wall;
    vec2 ends;
    float start;    // height of the origin over the middle
    float heading;  // change of that height along the ray
};

// Roots for the parts of an origin and a direction that lie across the axis. `is_on`: the origin is on the wall;
// as with a sphere, its roots would be noise along the wall. `is_in`: the ray cannot miss.
vec2 cross_wall(vec3 beside, vec3 across, float radius, bool is_on, bool is_in) {
    float square = dot(across, across);
    float c = dot(beside, beside) - radius * radius;
    if (square == 0.0) return vec2(c <= 0.0 ? -FAR : FAR, FAR);
    float b = -dot(beside, across);
    if (is_on) {
        float chord = 2.0 * b / square;
        return vec2(0.0, chord);
    }
    vec3 closest = beside + b / square * across;
    float rest = radius * radius - dot(closest, closest);
    if (rest < 0.0 && !is_in) return vec2(FAR, 0.0);
    float root = sqrt(square * larger(rest, 0.0));
    float q = b >= 0.0 ? b + root : b - root;
    float here = q / square;
    float there = q == 0.0 ? 0.0 : c / q;
    return b >= 0.0 ? vec2(there, here) : vec2(here, there);
}

CylinderCrossing cross_cylinder(Ray ray, Cylinder cylinder, int shape) {
    vec3 from = ray.origin - cylinder.center;
    float start = dot(from, cylinder.axis);
    float heading = dot(ray.direction, cylinder.axis);
    vec3 beside = from - start * cylinder.axis;
    vec3 across = ray.direction - heading * cylinder.axis;
    bool is_own = shape == ray.origin_shape;
    float to_wall = abs(cylinder.radius - length(beside));
    float to_end = abs(cylinder.half_height - abs(start));
    bool is_on = is_own && (cylinder.is_capped == 0 || to_wall <= to_end);
    vec2 wall = cross_wall(beside, across, cylinder.radius, is_on, is_own);
    vec2 ends = between_faces(start, heading, cylinder.half_height);
    return CylinderCrossing(wall, ends, start, heading);
}

// The distance t if the wall reaches to that height, else 0.
float on_wall(CylinderCrossing crossing, float t, float half_height) {
    float height = crossing.start + t * crossing.heading;
    return abs(height) <= half_height ? t : 0.0;
}

float cylinder_distance(Ray ray, Cylinder cylinder, int shape) {
    bool is_own = shape == ray.origin_shape;
    if (is_own && !ray.inward) return 0.0;
    CylinderCrossing crossing = cross_cylinder(ray, cylinder, shape);
    if (cylinder.is_capped == 0) {
        if (crossing.wall.x > crossing.wall.y) return 0.0;
        float far = on_wall(crossing, is_own ? larger(crossing.wall.y, NO_WAY) : crossing.wall.y,
                                    cylinder.half_height);
        if (is_own) return far;
        float near = on_wall(crossing, crossing.wall.x, cylinder.half_height);
        return near > 0.0 ? near : far;
    }
    float leaves = lesser(crossing.wall.y, crossing.ends.y);
    if (is_own) return larger(leaves, NO_WAY);
    float enters = larger(crossing.wall.x, crossing.ends.x);
    if (enters > leaves) return 0.0;
    return enters > 0.0 ? enters : leaves;
}

// Whether the ray hits a cap, on the side `inside`.
bool is_at_end(CylinderCrossing crossing, bool inside) {
    return inside ? crossing.ends.y <= crossing.wall.y : crossing.ends.x >= crossing.wall.x;
}

Surface cylinder_surface(Ray ray, vec3 p, int shape) {
    Cylinder cylinder = cylinder_at(shape - first_cylinder());
    CylinderCrossing crossing = cross_cylinder(ray, cylinder, shape);
    bool inside = shape == ray.origin_shape || larger(crossing.wall.x, crossing.ends.x) <= 0.0;
    vec3 offset = p - cylinder.center;
    if (cylinder.is_capped != 0 && is_at_end(crossing, inside)) {
        vec3 facing = (crossing.heading < 0.0) == inside ? -cylinder.axis : cylinder.axis;
        vec3 on_cap = p - (dot(offset, facing) - cylinder.half_height) * facing;
        return Surface(on_cap, facing, shape, cylinder.material, NO_LIGHT);
    }
    float height = clamp(dot(offset, cylinder.axis), -cylinder.half_height, cylinder.half_height);
    vec3 normal = normalized(offset - dot(offset, cylinder.axis) * cylinder.axis);
    vec3 position = cylinder.center + height * cylinder.axis + cylinder.radius * normal;
    return Surface(position, normal, shape, cylinder.material, NO_LIGHT);
}
