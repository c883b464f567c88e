// What probes hold: maps of directions, read between their texels.

uniform sampler2D probe_light;      // irradiance by the normal of what is lit, less what is seen directly
uniform sampler2D probe_distances;  // mean distance and mean squared distance by direction
uniform sampler2D probe_places;     // how far it stands from the middle of its cell; a: 1, 0 where it is of no use

struct MapPlace {
    ivec2 texel;  // the first of four
    vec2 beyond;  // way to the last, 0 to 1
};

MapPlace place_in_map(int probe, int side, vec3 direction) {
    precise vec2 place = (to_octahedron(direction) * 0.5 + 0.5) * float(side) + 0.5;
    precise vec2 first = clamp(floor(place), 0.0, float(side));
    precise vec2 beyond = place - first;
    return MapPlace(corner_of_map(probe, side) + ivec2(first), beyond);
}

vec4 between_texels(vec4 a, vec4 b, vec4 c, vec4 d, vec2 beyond) {
    precise vec4 low = a + beyond.x * (b - a);
    precise vec4 high = c + beyond.x * (d - c);
    precise vec4 value = low + beyond.y * (high - low);
    return value;
}

vec3 light_at_probe(int probe, vec3 normal) {
    precise MapPlace at = place_in_map(probe, LIGHT_SIDE, normal);
    precise vec4 a = texelFetch(probe_light, at.texel, 0);
    precise vec4 b = texelFetch(probe_light, at.texel + ivec2(1, 0), 0);
    precise vec4 c = texelFetch(probe_light, at.texel + ivec2(0, 1), 0);
    precise vec4 d = texelFetch(probe_light, at.texel + ivec2(1, 1), 0);
    return between_texels(a, b, c, d, at.beyond).rgb;
}

vec2 distances_at_probe(int probe, vec3 direction) {
    precise MapPlace at = place_in_map(probe, DISTANCE_SIDE, direction);
    precise vec4 a = texelFetch(probe_distances, at.texel, 0);
    precise vec4 b = texelFetch(probe_distances, at.texel + ivec2(1, 0), 0);
    precise vec4 c = texelFetch(probe_distances, at.texel + ivec2(0, 1), 0);
    precise vec4 d = texelFetch(probe_distances, at.texel + ivec2(1, 1), 0);
    return between_texels(a, b, c, d, at.beyond).rg;
}

vec4 place_of_probe(int probe) {
    return texelFetch(probe_places, ivec2(probe % PROBES_IN_ROW, probe / PROBES_IN_ROW), 0);
}
