// Data of probes: maps of directions, interpolated between their texels.
//
// probe_light_at: irradiance by the normal of the lit surface, without light that reaches it directly.
// probe_distances_at: mean distance and mean squared distance by direction. probe_place_at: offset of a probe from the
// middle of its cell; a: 1, or 0 where the probe is not used.

struct MapPlace {
    ivec2 texel;  // the first of four
    vec2 beyond;  // way to the last of them, 0 to 1 along each axis
};

MapPlace place_in_map(int probe, int side, vec3 direction) {
    vec2 place = (to_octahedron(direction) * 0.5 + 0.5) * float(side) + 0.5;
    vec2 first = clamp(floor(place), 0.0, float(side));
    vec2 beyond = place - first;
    return MapPlace(corner_of_map(probe, side) + ivec2(first), beyond);
}

vec4 between_texels(vec4 a, vec4 b, vec4 c, vec4 d, vec2 beyond) {
    vec4 low = a + beyond.x * (b - a);
    vec4 high = c + beyond.x * (d - c);
    vec4 value = low + beyond.y * (high - low);
    return value;
}

vec3 light_at_probe(int probe, vec3 normal) {
    MapPlace at = place_in_map(probe, LIGHT_SIDE, normal);
    vec4 a = probe_light_at(at.texel);
    vec4 b = probe_light_at(at.texel + ivec2(1, 0));
    vec4 c = probe_light_at(at.texel + ivec2(0, 1));
    vec4 d = probe_light_at(at.texel + ivec2(1, 1));
    return between_texels(a, b, c, d, at.beyond).rgb;
}

vec2 distances_at_probe(int probe, vec3 direction) {
    MapPlace at = place_in_map(probe, DISTANCE_SIDE, direction);
    vec4 a = probe_distances_at(at.texel);
    vec4 b = probe_distances_at(at.texel + ivec2(1, 0));
    vec4 c = probe_distances_at(at.texel + ivec2(0, 1));
    vec4 d = probe_distances_at(at.texel + ivec2(1, 1));
    return between_texels(a, b, c, d, at.beyond).rg;
}

vec4 place_of_probe(int probe) {
    ivec2 texel = ivec2(probe % PROBES_IN_ROW, probe / PROBES_IN_ROW);
    return probe_place_at(texel);
}
