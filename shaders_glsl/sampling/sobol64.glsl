// 64 points in four dimensions, Owen-scrambled like the 16 of sampling/sobol.glsl. The tree of a scramble has 63 nodes,
// so it takes two words: `tree.y` holds the bits of the last level.

uint owen_scramble_64(uint v, uvec2 tree) {
    uint flips = (tree.x & 1u) << 5u;
    flips |= ((tree.x >> (1u + (v >> 5u))) & 1u) << 4u;
    flips |= ((tree.x >> (3u + (v >> 4u))) & 1u) << 3u;
    flips |= ((tree.x >> (7u + (v >> 3u))) & 1u) << 2u;
    flips |= ((tree.x >> (15u + (v >> 2u))) & 1u) << 1u;
    flips |= (tree.y >> (v >> 1u)) & 1u;
    return v ^ flips;
}

// A point in two of four dimensions, in multiples of 1/64. Each bit of its number adds a constant, modulo 2, to the
// four coordinates; the first coordinate has the lowest six bits. The first two dimensions are those of Sobol's
// sequence. The last two are the same in a linear order of the points, chosen from all upper triangular orders: the
// four dimensions have t = 1 (Niederreiter 1987), and those of Sobol's sequence have t = 2. `trees`: random bits for x
// and for y.
uvec2 sobol_cell_64(uint index, bool last, uvec4 trees) {
    uint all = (index & 1u) * 0x820820u ^ (index >> 1u & 1u) * 0x430C10u ^ (index >> 2u & 1u) * 0xA08A08u
             ^ (index >> 3u & 1u) * 0x314F04u ^ (index >> 4u & 1u) * 0xE9A882u ^ (index >> 5u) * 0xBE5CC1u;
    uint two = last ? all >> 12u : all;
    return uvec2(owen_scramble_64(two & 63u, trees.xy), owen_scramble_64(two >> 6u & 63u, trees.zw));
}

// A random place in the cell: 16 bits for either dimension.
vec2 sobol_place_64(uvec2 cell, uint low) {
    uvec2 bits = (cell << 26u) | (uvec2(low, low >> 16u) & 0xFFFFu) << 10u;
    return vec2(unit_float(bits.x), unit_float(bits.y));
}
