// A path, from the camera or from a lamp, meets a surface: the data to scatter there, and how the path goes on.

struct Meeting {
    Vertex vertex;
    Normals normals;  // on the side that the path comes from
    Ray ray;          // leaves the surface, still in the direction of the path
    vec3 behind;      // absorption per unit length on the other side
    uint beyond;      // counts of the glasses with a priority on the other side, or volumes where HAS_RANKS
    int medium;       // on the other side
};

// The material of this sample: a principled surface with transmission acts as glass in part of the samples.
Material part_met(Material material, inout Sampler rng) {
    if (!HAS_TRANSMISSION || material.kind != PRINCIPLED) return material;
    Material part = met_part(material, next_1d(rng));
    return part;
}

// The vertex with the direction in which its facets are rougher, where its material has one.
Vertex with_grain(Vertex vertex, Ray ray, Surface surface) {
    Material material = vertex.material;
    bool may_have = material.kind == METAL || material.kind == PRINCIPLED;
    if (!may_have || material.ior == 1.0) return vertex;
    Tangents tangents = grain_tangents(ray, surface);
    float turn = material.crossed;
    vec3 along = cos(turn) * tangents.along + sin(turn) * tangents.up;
    return vertex_along(vertex, along, material.ior);
}

// Absorption per unit length behind a surface; `enters`: whether the inside of the object lies behind it.
vec3 absorption_behind(Path path, Material material, bool enters) {
    if (!HAS_ATTENUATION) return vec3(0.0);
    if (is_nested(material)) {
        uint counts = counts_beyond(path.counts, material.details, enters);
        return absorption_of_glass(glass_around(counts));
    }
    if (material.kind != DIELECTRIC) return path.absorption;
    return enters ? absorption_of_glass(material.details) : vec3(0.0);
}

// `by_shading`: the path scatters around the normal for shading where that is possible; else around the true one.
Meeting meet(Path path, Surface surface, Material material, bool by_shading) {
    vec3 direction = path.ray.direction;
    vec3 facing = true_normal(surface);
    float side = dot(direction, facing) < 0.0 ? 1.0 : -1.0;  // 1: the path meets the outer side
    facing *= side;
    vec3 shading = side * (HAS_NORMAL_MAP ? bent_normal(path.ray, surface) : surface.normal);
    mat3 frame = by_shading ? shading_frame(facing, shading, direction) : frame_around(facing);
    Vertex vertex = vertex_of(frame, to_local(frame, -direction), material, side > 0.0);
    if (HAS_ANISOTROPY) vertex = with_grain(vertex, path.ray, surface);
    uint beyond = path.counts;
    if (is_nested(material)) {
        beyond = counts_beyond(path.counts, material.details, side > 0.0);
        vertex.eta = ior_around(path.counts) / ior_around(beyond);
        if (is_rough_glass(material)) {
            uint around = side > 0.0 ? path.counts : beyond;
            vertex.material.details = facets_against(material.details, around);
            if (material.alpha * abs(vertex.eta - 1.0) < SMOOTHEST) vertex.material.alpha = 0.0;
        }
    }
    vec3 behind = absorption_behind(path, material, side > 0.0);
    Ray ray = Ray(surface.position, direction, surface.shape, side < 0.0);
    int medium = path.flight.medium;
    if (HAS_MEDIA || HAS_RANKS) cross_bounds(medium, beyond, object_number(surface.shape), side > 0.0);
    if (HAS_RANKS && material.kind == DIELECTRIC) vertex.eta = ior_of(path.counts) / ior_of(beyond);
    if (HAS_DISPERSION && disperses(material)) vertex.etas = etas_of(vertex, path.throughput);
    return Meeting(vertex, Normals(facing, shading), ray, behind, beyond, medium);
}

// Whether the path is lost: a normal for shading scatters it through the surface, or back where it should cross.
bool is_lost(Meeting at, Scattering next) {
    return HAS_SHADING && (dot(next.direction, at.normals.facing) < 0.0) != next.crosses;
}

// Sends the path on from the surface in the scattered direction.
void leave(inout Path path, Meeting at, Scattering next) {
    Ray ray = at.ray;
    ray.direction = next.direction;
    ray.inward = ray.inward != next.crosses;
    path.ray = ray;
    if (HAS_ATTENUATION && next.crosses) path.absorption = at.behind;
    if ((HAS_NESTED || HAS_RANKS) && next.crosses) path.counts = at.beyond;
    if (HAS_MEDIA && next.crosses) path.flight.medium = at.medium;
    path.depth += 1;
}

// Takes the light away that a segment of length `distance` loses. A segment that meets glass from inside lay in it.
void absorb(inout Path path, Material material, bool is_inside, float distance) {
    if (!HAS_ATTENUATION) return;
    bool is_glass = material.kind == DIELECTRIC && !is_nested(material);
    if (is_glass && is_inside) path.absorption = absorption_of_glass(material.details);
    path.throughput *= share_left(path.absorption, distance);
}

// Whether a surface of glass lies in another glass that stays around the path: then the surface has no effect.
bool is_within_other_glass(Path path, Material material, bool enters) {
    if (!is_nested(material)) return false;
    uint beyond = counts_beyond(path.counts, material.details, enters);
    return glass_around(beyond) == glass_around(path.counts);
}

// The path goes on through such a surface. No sampled light has passed it, so pdf is 0.
void pass_glass(inout Path path, Surface surface, Material material, bool enters) {
    record_passing(EVENT_PASSED_GLASS);
    path.counts = counts_beyond(path.counts, material.details, enters);
    path.ray = Ray(surface.position, path.ray.direction, surface.shape, enters);
    path.pdf = 0.0;
}
