// Nets of 64, 256 or 1024 points in four dimensions, with their binary digits scrambled.
//
// Numbers have their digits in reverse here: the lowest bit is the first digit. A scramble multiplies them by a random
// odd number and adds a random one. Two numbers that share exactly their first k digits then become two random numbers
// that share as many, and all such pairs are equally likely. The nested scramble of Owen (1995) makes the same of each
// pair, so every mean of a block has the same variance with both.

const uint DIGITS = BLOCK > 256 ? 10u : BLOCK > 64 ? 8u : 6u;  // the binary logarithm of BLOCK

uint scrambled(uint v, uint seed, uint shift) {
    return v * (seed | 1u) + shift;
}

// The number of a point after the shuffle: sets of dimensions are combined as in sampling/sobol.glsl.
uint net_order(uint point, uint seed) {
    uint above = 32u - DIGITS;
    return bitfieldReverse(scrambled(bitfieldReverse(point) >> above, seed, seed >> 16u)) >> above;
}

// The last two of the four dimensions are the first two in another linear order of the points, found by a search. 64
// points then have t = 1 (Niederreiter 1987), 256 and 1024 points have t = 2. Orders with the same t need as many
// operations or more.
uint last_order(uint index) {
    if (BLOCK > 256) return index ^ ((index >> 5u) & 31u) ^ ((index >> 7u) & 7u) ^ ((index >> 8u) & 3u);
    if (BLOCK > 64) return index ^ ((index >> 3u) & 7u) ^ ((index >> 5u) & 1u);
    return index ^ ((index >> 2u) & 3u) ^ (index >> 5u);
}

// A point in two of four dimensions, the first two or the last two. The first one is the number itself, as its digits
// are in reverse. The second one of Sobol's sequence is Pascal's triangle modulo 2 times the digits of the number.
uvec2 net_point(uint index, bool last) {
    uint x = last ? last_order(index) : index;
    uint y = x ^ ((x >> 1u) & 0x155u);
    y ^= (y >> 2u) & 0x333u;
    y ^= (y >> 4u) & 0x0Fu;
    if (DIGITS > 8u) y ^= (y >> 8u) & 3u;
    return uvec2(x, y);
}

// A random place in the cell of a scrambled point: 16 bits for either dimension.
vec2 net_place(uvec2 point, uint low) {
    uint below = 16u - DIGITS;
    uint cells = bitfieldReverse((point.x & (uint(BLOCK) - 1u)) | (point.y & (uint(BLOCK) - 1u)) << 16u);
    uvec2 bits = (uvec2(cells, cells << 16u) & ~(0xFFFFFFFFu >> DIGITS)) | (uvec2(low, low >> 16u) & 0xFFFFu) << below;
    return vec2(unit_float(bits.x), unit_float(bits.y));
}
