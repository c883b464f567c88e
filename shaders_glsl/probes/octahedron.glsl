// Directions on a square: the octahedron |x| + |y| + |z| = 1, its lower half folded out over the upper one
// (Cigolle et al., "A Survey of Efficient Representations for Independent Unit Vectors", JCGT 2014).

vec2 signs_of(vec2 v) {
    return vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
}

// The place of a direction of any length but 0 on the square: each coordinate from -1 to 1.
vec2 to_octahedron(vec3 direction) {
    vec2 place = direction.xy / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    if (direction.z >= 0.0) return place;
    vec2 folded = (1.0 - abs(place.yx)) * signs_of(place);
    return folded;
}

vec3 from_octahedron(vec2 place) {
    vec3 direction = vec3(place, 1.0 - abs(place.x) - abs(place.y));
    if (direction.z < 0.0) direction.xy = (1.0 - abs(place.yx)) * signs_of(place);
    return normalized(direction);
}

// A map of directions has `side` inner texels along an edge, numbered from 1 on, and a border. With the border,
// interpolation needs no special case at the fold. Returns the inner texel that a texel stands for.
ivec2 inner_texel(ivec2 texel, int side) {
    if (texel.y == 0 || texel.y == side + 1) texel = ivec2(side + 1 - texel.x, clamp(texel.y, 1, side));
    if (texel.x == 0 || texel.x == side + 1) texel = ivec2(clamp(texel.x, 1, side), side + 1 - texel.y);
    return texel;
}

// The middle of an inner texel.
vec3 direction_of_texel(ivec2 texel, int side) {
    vec2 place = (vec2(texel) - 0.5) / float(side) * 2.0 - 1.0;
    return from_octahedron(place);
}
