// Rays against the triangles of meshes. Corners are relative to the middle of the tree, which no camera
// moves. Triangles are numbered after all shapes: first_triangle() is the number of the first.

// How far a ray starts off the triangle that it leaves, relative to the largest coordinate there: 16 times the
// rounding of a float. The distance of a point from the plane of a triangle takes about half of that.
const float CLEARANCE = 9.5367431640625e-7;

int mesh_of(Triangle triangle) { return int(triangle.owner & 0xFFFFu); }

int owner_of(Triangle triangle, int instance) {
    return instance > 0 ? instance_at(instance - 1).mesh : mesh_of(triangle);
}

// The number of the object of the scene that a shape belongs to: for a triangle, the number of its mesh.
int object_number(int shape) {
    if (!is_triangle(shape)) return shape;
    return first_mesh() + owner_of(triangle_of(shape), instance_of(shape));
}

// A ray turned into the z axis by a shear. Two triangles then see a shared corner or edge at the same place, to
// the last bit, and no ray passes between them ("Watertight Ray/Triangle Intersection", Woop, Benthin, Wald,
// JCGT 2013).
struct ShearedRay {
    vec3 origin;
    vec3 x;  // dot product with a vector: its x after the shear
    vec3 y;
    vec3 z;
    float skipped;  // distance to its start, by which it is shorter than the ray
};

// A triangle does not know the numbers of its neighbours. So a ray starts clear of its plane, on the ray's side.
vec3 start_among_triangles(Ray ray, vec3 place) {
    if (!is_triangle(ray.origin_shape) || instance_of(ray.origin_shape) > 0) return place;
    Triangle left = triangle_of(ray.origin_shape);
    vec3 away = abs(frame.tree_center);
    float largest = larger(larger(away.x, away.y), larger(away.z, left.reach));
    float shift = dot(left.normal, ray.direction) < 0.0 ? -CLEARANCE * largest : CLEARANCE * largest;
    place += shift * left.normal;
    return place;
}

ShearedRay sheared_along(vec3 origin, vec3 direction, float skipped) {
    vec3 size = abs(direction);
    bool along_x = size.x >= size.y && size.x >= size.z;
    bool along_y = !along_x && size.y >= size.z;
    vec3 z = along_x ? vec3(1.0, 0.0, 0.0) : along_y ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    vec3 x = z.zxy;
    vec3 y = z.yzx;
    float scale = 1.0 / dot(z, direction);
    vec3 shear_x = x - dot(x, direction) * scale * z;
    vec3 shear_y = y - dot(y, direction) * scale * z;
    return ShearedRay(origin, shear_x, shear_y, scale * z, skipped);
}

ShearedRay sheared_from(Start start, Ray ray) {
    if (!HAS_MESH) return ShearedRay(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
    return sheared_along(start_among_triangles(ray, start.place), ray.direction, start.skipped);
}

ShearedRay sheared(Ray ray) { return sheared_from(start_of(ray), ray); }

// How a ray leaves the triangle of an instance.
struct Left {
    vec3 shift;  // moves the origin clear of the triangle, in the frame of its mesh
    int instance;
};

// The axes of that frame may be rounded differently. So the shift is the sum of what each of them adds along the
// normal ("Physically Based Rendering", Pharr, Jakob, Humphreys, 4th edition, section 6.8.6).
Left left_by(Ray ray) {
    if (!HAS_INSTANCE || !is_triangle(ray.origin_shape)) return Left(vec3(0.0), 0);
    int instance = instance_of(ray.origin_shape);
    if (instance == 0) return Left(vec3(0.0), 0);
    Inward inward = inward_of(instance_at(instance - 1));
    vec3 size = abs(ray.origin) + abs(frame.tree_center) + inward.reach;
    vec3 rounded = vec3(
        dot(abs(inward.to_x), size), dot(abs(inward.to_y), size), dot(abs(inward.to_z), size));
    vec3 normal = triangle_of(ray.origin_shape).normal;
    float shift = CLEARANCE * dot(abs(normal), rounded);
    if (dot(normal, turned_in(inward, ray.direction)) < 0.0) shift = -shift;
    return Left(shift * normal, instance);
}

ShearedRay sheared_in(Ray ray, int instance) {
    Inward inward = inward_of(instance_at(instance - 1));
    Start near = start_of(ray);
    vec3 start = turned_in(inward, near.place - inward.origin);
    Left left = left_by(ray);
    if (left.instance == instance) start += left.shift;
    return sheared_along(start, turned_in(inward, ray.direction), near.skipped);
}

vec3 sheared_point(ShearedRay ray, vec3 corner) {
    vec3 offset = corner - ray.origin;
    vec3 point = vec3(dot(ray.x, offset), dot(ray.y, offset), dot(ray.z, offset) + ray.skipped);
    return point;
}

// The shares of the corners in the point that the ray meets, not yet divided by their sum. Their signs differ
// where the ray passes by.
vec3 corner_shares(vec3 a, vec3 b, vec3 c) {
    vec3 shares = vec3(c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
    return shares;
}

// The distance along the ray, not above 0 for a miss.
float triangle_distance(vec3 a, vec3 b, vec3 c) {
    vec3 shares = corner_shares(a, b, c);
    bool is_front = shares.x >= 0.0 && shares.y >= 0.0 && shares.z >= 0.0;
    bool is_back = shares.x <= 0.0 && shares.y <= 0.0 && shares.z <= 0.0;
    float sum = shares.x + shares.y + shares.z;
    if (!(is_front || is_back) || sum == 0.0) return 0.0;
    float t = (shares.x * a.z + shares.y * b.z + shares.z * c.z) / sum;
    return t;
}

// Whether a ray meets the side of a triangle that its mesh hides. `turn`: 1 where the corners turn about its normal in
// this order, 2 where they turn the other way, 0 where no side is hidden (glrt/packing/triangles.py).
bool meets_hidden(ShearedRay ray, vec3 a, vec3 b, vec3 c, uint turn) {
    vec3 shares = corner_shares(a, b, c);
    bool is_left = shares.x + shares.y + shares.z < 0.0;
    bool goes_up = ray.z.x + ray.z.y + ray.z.z > 0.0;  // along the axis that the ray is turned into
    bool along_normal = (is_left == goes_up) == (turn == 1u);
    return turn != 0u && along_normal;
}

vec3 unpacked_normal(uint bits) {
    vec2 flat_normal = vec2(ivec2(bits & 0xFFFFu, bits >> 16u)) / 32767.0 - 1.0;
    float z = 1.0 - abs(flat_normal.x) - abs(flat_normal.y);
    vec2 folded = 1.0 - abs(flat_normal.yx);
    float x = flat_normal.x >= 0.0 ? folded.x : -folded.x;
    float y = flat_normal.y >= 0.0 ? folded.y : -folded.y;
    vec3 normal = z >= 0.0 ? vec3(flat_normal, z) : vec3(x, y, z);
    return normal;
}

// The normal of a corner, relative to the axes of the scene.
vec3 corner_normal(Corner corner, int instance) {
    vec3 normal = unpacked_normal(corner.normal);
    if (instance > 0) normal = facing_of(instance_at(instance - 1), normal);
    vec3 unit = normalized(normal);
    return unit;
}

// The true normal of a triangle, which defines its two sides.
vec3 triangle_normal(Triangle triangle, int instance) {
    if (instance == 0) return triangle.normal;
    vec3 normal = normalized(facing_of(instance_at(instance - 1), triangle.normal));
    return normal;
}

const float CANCELLED = 1.0e-6;  // squared length of a mean of opposite unit normals, which has no direction

// The normal interpolated between the normals of the corners, on the side of the triangle's own.
vec3 smooth_normal(vec3 own, int instance, vec3 shares, Corner a, Corner b, Corner c) {
    vec3 mean = shares.x * corner_normal(a, instance)
                      + shares.y * corner_normal(b, instance)
                      + shares.z * corner_normal(c, instance);
    if (dot(mean, mean) < CANCELLED) return own;
    vec3 normal = normalized(mean);
    return dot(normal, own) < 0.0 ? -normal : normal;
}

// The shares of the corners in the point that the ray met, 1 in sum.
vec3 met_shares(Ray ray, int instance, Corner a, Corner b, Corner c) {
    ShearedRay turned = sheared(ray);
    if (instance > 0) turned = sheared_in(ray, instance);
    vec3 shares = corner_shares(
        sheared_point(turned, a.position), sheared_point(turned, b.position), sheared_point(turned, c.position));
    float sum = shares.x + shares.y + shares.z;
    if (sum == 0.0) return vec3(1.0, 0.0, 0.0);  // by rounding, where a sliver is seen from its edge
    shares /= sum;
    return shares;
}

Surface mesh_surface(Ray ray, int shape) {
    Triangle triangle = triangle_of(shape);
    Corner a = corner_at(triangle.corners.x);
    Corner b = corner_at(triangle.corners.y);
    Corner c = corner_at(triangle.corners.z);
    int instance = instance_of(shape);
    vec3 shares = met_shares(ray, instance, a, b, c);
    vec3 place = shares.x * a.position + shares.y * b.position + shares.z * c.position;
    if (instance > 0) place = place_of(instance_at(instance - 1), place);
    Mesh mesh = mesh_at(owner_of(triangle, instance));
    vec3 normal = triangle_normal(triangle, instance);
    if (HAS_SMOOTH && mesh.is_smooth != 0) normal = smooth_normal(normal, instance, shares, a, b, c);
    int light = HAS_MESH_LIGHT && instance == 0 ? int(triangle.owner >> 16u) - 1 : NO_LIGHT;
    return Surface(place + frame.tree_center, normal, shape, mesh.material, light);
}

// The true normal of a surface, which defines its two sides; a mesh may have another normal for shading.
vec3 true_normal(Surface surface) {
    if (!HAS_SMOOTH || !is_triangle(surface.shape)) return surface.normal;
    return triangle_normal(triangle_of(surface.shape), instance_of(surface.shape));
}

// The colour interpolated between the colours of the corners, in the point of a triangle that the ray met. Corners of
// the same colour give that colour to the bit.
vec3 vertex_color(Ray ray, int shape) {
    ivec3 corners = triangle_of(shape).corners;
    Corner a = corner_at(corners.x);
    vec3 shares = met_shares(ray, instance_of(shape), a, corner_at(corners.y), corner_at(corners.z));
    vec3 first = tint_at(corners.x).color;
    vec3 color = first + shares.y * (tint_at(corners.y).color - first)
                       + shares.z * (tint_at(corners.z).color - first);
    return clamp(color, 0.0, 1.0);
}
