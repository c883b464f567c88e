// Triangles of meshes as lamps: points on them, even in area.

// A triangle that emits, relative to the camera.
struct LampTriangle {
    vec3 a;
    vec3 edge_b;  // from a to the other corners
    vec3 edge_c;
    vec3 across;  // along the normal, as long as the area
    int mesh;
};

LampTriangle lamp_triangle(int shape) {
    Triangle triangle = triangle_of(shape);
    vec3 a = corner_at(triangle.corners.x).position;
    vec3 edge_b = corner_at(triangle.corners.y).position - a;
    vec3 edge_c = corner_at(triangle.corners.z).position - a;
    vec3 across = 0.5 * cross(edge_b, edge_c);
    return LampTriangle(a + frame.tree_center, edge_b, edge_c, across, mesh_of(triangle));
}

bool is_beside(LampTriangle triangle, vec3 origin) {
    float z = dot(triangle.a - origin, triangle.across);
    return abs(z) > 0.0;
}

// A point as shares of the two edges, even in area.
vec2 sample_triangle(vec2 u) {
    float root = sqrt(u.x);
    vec2 shares = vec2(root * (1.0 - u.y), root * u.y);
    return shares;
}

// Points are even in area, in every method.
float pdf_triangle(LampTriangle triangle, Ray ray, float distance) {
    float facing = abs(dot(ray.direction, triangle.across));  // the area that it shows
    if (facing == 0.0) return 0.0;
    float pdf = distance / facing * distance;
    return pdf;
}
