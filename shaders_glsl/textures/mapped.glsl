// Effects of images on a material and on the normal of its surface.

const float ROUGHNESS_STEPS = 255.0;  // the struct Gloss has a row for each

// Roughness is rounded to steps. Between them energy would be lost or won, as the albedos of facets are tabled by step.
Material with_gloss(Material material, Maps maps, Coordinates at) {
    Material found = material;
    if (maps.metallic != NO_MAP) found.metallic *= number_at(maps.metallic, at);
    if (maps.roughness == NO_MAP) return found;
    float roughness = material.roughness * clamp(number_at(maps.roughness, at), 0.0, 1.0);
    int step = int(roughness * ROUGHNESS_STEPS + 0.5);
    float stepped = float(step) / ROUGHNESS_STEPS;
    found.alpha = stepped * stepped;
    found.details += step;
    return found;
}

Material mapped(Ray ray, Surface surface, Material material) {
    Material found = material;
    Maps maps = maps_at(surface.material);
    Coordinates at = coordinates_of(ray, surface);
    if (HAS_COLOR_MAP && maps.color != NO_MAP) found.color *= clamp(color_at(maps.color, at), 0.0, 1.0);
    if (HAS_EMISSION_MAP && maps.emission != NO_MAP) found.emission *= color_at(maps.emission, at);
    if (HAS_GLOSS_MAP) found = with_gloss(found, maps, at);
    if (HAS_TRANSMISSION_MAP && maps.crossed != NO_MAP) found.crossed *= number_at(maps.crossed, at);
    if (HAS_COVERAGE_MAP && maps.coverage != NO_MAP) {
        found.coverage *= number_at(maps.coverage, at);
        if (maps.cutoff >= 0.0) found.coverage = found.coverage >= maps.cutoff ? 1.0 : 0.0;
    }
    return found;
}

// The material of a surface at the point that a ray met.
Material material_of(Ray ray, Surface surface) {
    Material material = material_at(surface.material);
    if (HAS_VERTEX_COLOR && is_triangle(surface.shape)) material.color *= vertex_color(ray, surface.shape);
    if (!HAS_MAP) return material;
    return mapped(ray, surface, material);
}

// Directions along a surface where u grows and where v falls, of any length.
struct Tangents {
    vec3 along;
    vec3 up;
};

Tangents triangle_tangents(int shape, int set) {
    ivec3 corners = triangle_of(shape).corners;
    int instance = instance_of(shape);
    vec3 a = corner_at(corners.x).position;
    vec3 b = corner_at(corners.y).position;
    vec3 c = corner_at(corners.z).position;
    if (instance > 0) {
        Instance row = instance_at(instance - 1);
        a = place_of(row, a);
        b = place_of(row, b);
        c = place_of(row, c);
    }
    Uv first = uv_at(corners.x);
    Uv second = uv_at(corners.y);
    Uv third = uv_at(corners.z);
    vec2 start = set == 0 ? first.first : first.second;
    vec2 one = (set == 0 ? second.first : second.second) - start;
    vec2 other = (set == 0 ? third.first : third.second) - start;
    float turn = one.x * other.y - other.x * one.y;
    float turned = turn < 0.0 ? -1.0 : turn > 0.0 ? 1.0 : 0.0;
    vec3 along = turned * ((b - a) * other.y - (c - a) * one.y);
    vec3 down = turned * ((c - a) * one.x - (b - a) * other.x);
    return Tangents(along, -down);
}

// The tangent interpolated between those of the corners, for which images of normals are made; 0 where a corner has
// none.
vec3 corner_tangent(Ray ray, int shape) {
    ivec3 corners = triangle_of(shape).corners;
    int instance = instance_of(shape);
    vec3 a = tangent_at(corners.x).along;
    vec3 b = tangent_at(corners.y).along;
    vec3 c = tangent_at(corners.z).along;
    if (a == vec3(0.0) || b == vec3(0.0) || c == vec3(0.0)) return vec3(0.0);
    Corner corner = corner_at(corners.x);
    vec3 shares = met_shares(ray, instance, corner, corner_at(corners.y), corner_at(corners.z));
    vec3 along = a + shares.y * (b - a) + shares.z * (c - a);
    if (instance == 0) return along;
    Instance row = instance_at(instance - 1);
    along = along.x * row.from_x + along.y * row.from_y + along.z * row.from_z;
    return along;
}

Tangents mesh_tangents(Ray ray, int shape, int set) {
    Tangents found = triangle_tangents(shape, set);
    vec3 along = set == 0 ? corner_tangent(ray, shape) : vec3(0.0);
    if (along != vec3(0.0)) found.along = along;
    return found;
}

Tangents tangents_of(Ray ray, Surface surface, int set) {
    if (HAS_MESH && is_triangle(surface.shape)) return mesh_tangents(ray, surface.shape, set);
    vec3 normal = surface.normal;
    if (HAS_SPHERE && up_to_sphere(surface.shape)) {
        return Tangents(vec3(-normal.z, 0.0, normal.x), vec3(0.0, 1.0, 0.0));
    }
    Axes axes = axes_at(surface.shape - first_plane());
    vec3 along = cross(axes.v, normal);
    if (dot(along, axes.u) < 0.0) along = -along;
    return Tangents(along, -axes.v);
}

// The same of unit length and at right angles, for facets that differ by direction. Where no texture coordinates say
// what u is, it grows along the horizon, as on a sphere; round the axis of a cylinder, and along the edges of a box.
Tangents grain_tangents(Ray ray, Surface surface) {
    vec3 normal = surface.normal;
    vec3 along = vec3(-normal.z, 0.0, normal.x);
    vec3 up = vec3(0.0, 1.0, 0.0);
    if (HAS_BOX && is_box(surface.shape)) {
        Box box = box_at(surface.shape - first_box());
        along = abs(dot(box.axis_x, normal)) < 0.5 ? box.axis_x : -box.axis_z;
        up = cross(normal, along);
    } else if (HAS_CYLINDER && is_cylinder(surface.shape)) {
        Cylinder cylinder = cylinder_at(surface.shape - first_cylinder());
        along = cross(cylinder.axis, surface.position - cylinder.center);
        up = cross(normal, along);
    } else {
        Tangents found = tangents_of(ray, surface, 0);
        if (found.along != vec3(0.0)) {
            along = found.along;
            up = found.up;
        }
    }
    along -= dot(along, normal) * normal;
    float square = dot(along, along);
    along = square > 0.0 ? along / sqrt(square) : frame_around(normal)[0];
    vec3 across = cross(normal, along);
    if (dot(across, up) < 0.0) across = -across;
    return Tangents(along, across);
}

// Turns an offset along u and against v of an image into an offset along u and against v of the surface. So an image
// that is turned or mirrored turns its normals too.
vec2 turned_back(Map map, vec2 offset) {
    float size = dot(map.u.xy, map.u.xy);
    if (!(size > 0.0)) return offset;
    vec2 across = map.u.xy / sqrt(size);
    float turn = map.u.x * map.v.y - map.u.y * map.v.x;
    float down = turn < 0.0 ? -offset.y : offset.y;
    vec2 turned = vec2(offset.x * across.x + down * across.y, down * across.x - offset.x * across.y);
    return turned;
}

// The normal that the image of a material gives, on the side of the surface's own.
vec3 bent_normal(Ray ray, Surface surface) {
    vec3 normal = surface.normal;
    int number = maps_at(surface.material).normal;
    if (number == NO_MAP) return normal;
    Map map = map_at(number);
    Tangents tangents = tangents_of(ray, surface, map.set);
    vec3 along = tangents.along - dot(tangents.along, normal) * normal;
    float size = dot(along, along);
    if (!(size > 0.0)) return normal;
    along /= sqrt(size);
    vec3 up = cross(normal, along);
    if (dot(up, tangents.up) < 0.0) up = -up;
    vec3 texel = 2.0 * map_value(number, coordinates_of(ray, surface)).xyz - 1.0;
    vec2 turned = turned_back(map, texel.xy);
    vec3 bent = map.strength * (turned.x * along + turned.y * up) + texel.z * normal;
    if (!(dot(bent, normal) > 0.0)) return normal;
    vec3 unit = normalized(bent);
    return unit;
}
