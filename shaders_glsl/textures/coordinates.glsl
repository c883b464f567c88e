// Texture coordinates of a point of a surface: u to the right of an image and v downwards, each from 0 to 1 from
// edge to edge. docs/how-to/textures.md has the formulas.

struct Coordinates {
    vec2 first;
    vec2 second;  // second set, of meshes
};

Coordinates triangle_coordinates(Ray ray, int shape) {
    ivec3 corners = triangle_of(shape).corners;
    Corner corner = corner_at(corners.x);
    vec3 shares = met_shares(ray, instance_of(shape), corner, corner_at(corners.y), corner_at(corners.z));
    Uv a = uv_at(corners.x);
    Uv b = uv_at(corners.y);
    Uv c = uv_at(corners.z);
    vec2 first = a.first + shares.y * (b.first - a.first) + shares.z * (c.first - a.first);
    vec2 second = a.second + shares.y * (b.second - a.second) + shares.z * (c.second - a.second);
    return Coordinates(first, second);
}

Coordinates coordinates_of(Ray ray, Surface surface) {
    if (HAS_MESH && is_triangle(surface.shape)) return triangle_coordinates(ray, surface.shape);
    if (HAS_SPHERE && up_to_sphere(surface.shape)) {
        vec2 place = vec2(turns_of(surface.normal), descent_of(surface.normal));
        return Coordinates(place, place);
    }
    Axes axes = axes_at(surface.shape - first_plane());
    vec3 offset = surface.position - axes.origin;
    vec2 place = vec2(dot(axes.u, offset), dot(axes.v, offset));
    return Coordinates(place, place);
}
