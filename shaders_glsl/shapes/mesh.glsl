// Rays against the triangles of meshes. Corners are relative to the middle of the tree, which no camera
// moves. A triangle is numbered after all shapes: first_triangle() is the number of the first.

// How far a ray starts off the triangle that it leaves, relative to the largest coordinate there: 16 times the
// rounding of a float, as the distance of a point from the plane of a triangle takes about half as many.
const float CLEARANCE = 9.5367431640625e-7;

int first_triangle() { return first_mesh() + mesh_count(); }

bool is_triangle(int shape) { return HAS_MESH && shape >= first_triangle(); }

Triangle triangle_of(int shape) { return triangle_at(shape - first_triangle()); }

int mesh_of(Triangle triangle) { return int(triangle.owner & 0xFFFFu); }

// The number of what is an object of the scene: for a triangle, that of its mesh.
int object_number(int shape) {
    return is_triangle(shape) ? first_mesh() + mesh_of(triangle_of(shape)) : shape;
}

// A ray turned into the z axis by a shear: two triangles see a corner or an edge that they share at the
// same place, to the last bit, and so no ray passes between them ("Watertight Ray/Triangle Intersection",
// Woop, Benthin, Wald, JCGT 2013).
struct ShearedRay {
    vec3 origin;
    vec3 x;  // what to multiply a vector by for its coordinates
    vec3 y;
    vec3 z;
};

// A triangle knows its neighbours by no number: a ray leaves on its own side of its plane, clear of it.
vec3 start_among_triangles(Ray ray) {
    precise vec3 place = ray.origin - frame.tree_center;
    if (!is_triangle(ray.origin_shape)) return place;
    precise Triangle left = triangle_of(ray.origin_shape);
    precise vec3 away = abs(frame.tree_center);
    precise float largest = larger(larger(away.x, away.y), larger(away.z, left.reach));
    precise float shift = dot(left.normal, ray.direction) < 0.0 ? -CLEARANCE * largest : CLEARANCE * largest;
    place += shift * left.normal;
    return place;
}

ShearedRay sheared(Ray ray) {
    if (!HAS_MESH) return ShearedRay(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    precise vec3 size = abs(ray.direction);
    bool along_x = size.x >= size.y && size.x >= size.z;
    bool along_y = !along_x && size.y >= size.z;
    precise vec3 z = along_x ? vec3(1.0, 0.0, 0.0) : along_y ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    precise vec3 x = z.zxy;
    precise vec3 y = z.yzx;
    precise float scale = 1.0 / dot(z, ray.direction);
    precise vec3 shear_x = x - dot(x, ray.direction) * scale * z;
    precise vec3 shear_y = y - dot(y, ray.direction) * scale * z;
    return ShearedRay(start_among_triangles(ray), shear_x, shear_y, scale * z);
}

vec3 sheared_point(ShearedRay ray, vec3 corner) {
    precise vec3 offset = corner - ray.origin;
    precise vec3 point = vec3(dot(ray.x, offset), dot(ray.y, offset), dot(ray.z, offset));
    return point;
}

// The shares of the corners in the point that the ray meets, not yet divided by their sum; their signs
// differ where it passes by.
vec3 corner_shares(vec3 a, vec3 b, vec3 c) {
    precise vec3 shares = vec3(c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
    return shares;
}

// The distance along the ray, not above 0 for a miss.
float triangle_distance(vec3 a, vec3 b, vec3 c) {
    precise vec3 shares = corner_shares(a, b, c);
    bool is_front = shares.x >= 0.0 && shares.y >= 0.0 && shares.z >= 0.0;
    bool is_back = shares.x <= 0.0 && shares.y <= 0.0 && shares.z <= 0.0;
    precise float sum = shares.x + shares.y + shares.z;
    if (!(is_front || is_back) || sum == 0.0) return 0.0;
    precise float t = (shares.x * a.z + shares.y * b.z + shares.z * c.z) / sum;
    return t;
}

vec3 unpacked_normal(uint bits) {
    precise vec2 flat_normal = vec2(ivec2(bits & 0xFFFFu, bits >> 16u)) / 32767.0 - 1.0;
    precise float z = 1.0 - abs(flat_normal.x) - abs(flat_normal.y);
    precise vec2 folded = 1.0 - abs(flat_normal.yx);
    precise float x = flat_normal.x >= 0.0 ? folded.x : -folded.x;
    precise float y = flat_normal.y >= 0.0 ? folded.y : -folded.y;
    precise vec3 normal = z >= 0.0 ? vec3(flat_normal, z) : vec3(x, y, z);
    return normal;
}

// The normal between those of the corners, on the side of the triangle's own.
vec3 smooth_normal(Triangle triangle, vec3 shares, Corner a, Corner b, Corner c) {
    precise vec3 mean = shares.x * normalized(unpacked_normal(a.normal))
                      + shares.y * normalized(unpacked_normal(b.normal))
                      + shares.z * normalized(unpacked_normal(c.normal));
    if (dot(mean, mean) < 1.0e-6) return triangle.normal;  // opposite ones, about to vanish
    precise vec3 normal = normalized(mean);
    return dot(normal, triangle.normal) < 0.0 ? -normal : normal;
}

// The shares of the corners in the point that the ray met, 1 in sum.
vec3 met_shares(Ray ray, Corner a, Corner b, Corner c) {
    precise ShearedRay turned = sheared(ray);
    precise vec3 shares = corner_shares(
        sheared_point(turned, a.position), sheared_point(turned, b.position), sheared_point(turned, c.position));
    precise float sum = shares.x + shares.y + shares.z;
    if (sum == 0.0) return vec3(1.0, 0.0, 0.0);  // of rounding, where a sliver is seen from its edge
    shares /= sum;
    return shares;
}

Surface mesh_surface(Ray ray, int shape) {
    precise Triangle triangle = triangle_of(shape);
    precise Corner a = corner_at(triangle.corners.x);
    precise Corner b = corner_at(triangle.corners.y);
    precise Corner c = corner_at(triangle.corners.z);
    precise vec3 shares = met_shares(ray, a, b, c);
    precise vec3 place = shares.x * a.position + shares.y * b.position + shares.z * c.position;
    precise Mesh mesh = mesh_at(mesh_of(triangle));
    precise vec3 normal = triangle.normal;
    if (HAS_SMOOTH && mesh.is_smooth != 0) normal = smooth_normal(triangle, shares, a, b, c);
    int light = HAS_MESH_LIGHT ? int(triangle.owner >> 16u) - 1 : NO_LIGHT;
    return Surface(place + frame.tree_center, normal, shape, mesh.material, light);
}

// The normal of the surface as it is, which tells its sides; that of a mesh may be another, for shading.
vec3 true_normal(Surface surface) {
    if (HAS_SMOOTH && is_triangle(surface.shape)) return triangle_of(surface.shape).normal;
    return surface.normal;
}

// The colour between those of the corners, in the point of a triangle that the ray met: the same to the bit
// where theirs are.
vec3 vertex_color(Ray ray, int shape) {
    ivec3 corners = triangle_of(shape).corners;
    precise vec3 shares = met_shares(ray, corner_at(corners.x), corner_at(corners.y), corner_at(corners.z));
    precise vec3 first = tint_at(corners.x).color;
    precise vec3 color = first + shares.y * (tint_at(corners.y).color - first)
                       + shares.z * (tint_at(corners.z).color - first);
    return clamp(color, 0.0, 1.0);
}
