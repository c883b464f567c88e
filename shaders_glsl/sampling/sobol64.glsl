// 64 points in four dimensions, with their binary digits scrambled.
//
// Numbers have their digits in reverse here: the lowest bit is the first digit. A scramble multiplies them by a random
// odd number and adds a random one. Two numbers that share exactly their first k digits then become two random numbers
// that share as many, and all such pairs are equally likely. The nested scramble of Owen (1995) makes the same of each
// pair, so every mean of a block has the same variance with both.

uint scrambled(uint v, uint seed, uint shift) {
    return v * (seed | 1u) + shift;
}

// The number of a point after the shuffle: sets of dimensions are combined as in sampling/sobol.glsl.
uint sobol_order_64(uint point, uint seed) {
    return bitfieldReverse(scrambled(bitfieldReverse(point) >> 26u, seed, seed >> 16u)) >> 26u;
}

// The second dimension of Sobol's sequence, up to 2^16 points: Pascal's triangle modulo 2 times the digits of the
// number. The first dimension is the number itself, as its digits are in reverse.
uint sobol_second(uint index) {
    uint y = index ^ ((index >> 1u) & 0x5555u);
    y ^= (y >> 2u) & 0x3333u;
    y ^= (y >> 4u) & 0x0F0Fu;
    return y ^ ((y >> 8u) & 0x00FFu);
}

// A point in two of four dimensions, the first two or the last two. The last two are the first two in another linear
// order of the points: the four dimensions have t = 1 (Niederreiter 1987), those of Sobol's sequence have t = 2. Three
// orders with t = 1 take as few operations; none of them has a lower t for the first 16 and the first 32 points.
uvec2 sobol_point_64(uint index, bool last) {
    if (last) index ^= ((index >> 2u) & 3u) ^ (index >> 5u);
    return uvec2(index, sobol_second(index));
}

// A random place in the cell of a scrambled point: 16 bits for either dimension.
vec2 sobol_place_64(uvec2 point, uint low) {
    uint cells = bitfieldReverse((point.x & 63u) | (point.y & 63u) << 16u);
    uvec2 bits = (uvec2(cells, cells << 16u) & 0xFC000000u) | (uvec2(low, low >> 16u) & 0xFFFFu) << 10u;
    return vec2(unit_float(bits.x), unit_float(bits.y));
}
