// A net of up to 2^16 points in four dimensions, scrambled as the 64 of sampling/sobol64.glsl. Each number of first
// points that is a power of two is a net by itself, so it may grow.

const int NET_POINTS = 1 << 16;

// The number of a point after the shuffle.
uint net_order(uint point, uint seed) {
    return bitfieldReverse(scrambled(bitfieldReverse(point) >> 16u, seed, seed >> 16u)) >> 16u;
}

// A point in two of four dimensions, the first two or the last two, digits in reverse. The first two are Sobol's. The
// last two are the same in a linear order of the points, found by a search: up to 2^10 points, the four dimensions have
// t of at most 3, as Sobol's have.
uvec2 net_point(uint index, bool last) {
    if (last) {
        index ^= (index >> 1u) & 0x547Fu;
        index ^= (index >> 3u) & 0xC35u;
        index ^= (index >> 5u) & 0x6F7u;
    }
    return uvec2(index, sobol_second(index));
}

// A random place in the cell of a scrambled point: 16 digits of the point, and 16 random bits.
vec2 net_place(uvec2 point, uint low) {
    uvec2 cells = uvec2(bitfieldReverse(point.x), bitfieldReverse(point.y)) & 0xFFFF0000u;
    uvec2 bits = cells | (uvec2(low, low >> 16u) & 0xFFFFu);
    return vec2(unit_float(bits.x), unit_float(bits.y));
}
