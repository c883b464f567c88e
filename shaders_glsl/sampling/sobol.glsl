// The first 16 points of Sobol's sequence in four dimensions, Owen-scrambled.
//
// Sixteen points differ only in four bits of their numbers. So the nested uniform scramble of
// Owen (1995), a random bit at each of the 15 nodes of a binary tree, is computed in full;
// Burley ("Practical Hash-based Owen Scrambling", JCGT 2020) hashes 32 levels. The bits below the
// four are random. As in that paper, points are shuffled by scrambling their numbers, so that sets
// of dimensions can be combined ("padding").

// Flips each bit of v, below 16, by the bit of `tree` that belongs to the bits above it.
uint owen_scramble(uint v, uint tree) {
    uint flips = (tree & 1u) << 3u;
    flips |= ((tree >> (1u + (v >> 3u))) & 1u) << 2u;
    flips |= ((tree >> (3u + (v >> 2u))) & 1u) << 1u;
    flips |= (tree >> (7u + (v >> 1u))) & 1u;
    return v ^ flips;
}

// A table of sixteen numbers of four bits, the first one lowest.
uint table_at(uvec2 table, uint index) {
    uint word = index < 8u ? table.x : table.y;
    return (word >> (4u * (index & 7u))) & 15u;
}

// A point in two of four dimensions, the first two or the last two, in multiples of 1/16, by the
// direction numbers of Joe and Kuo (2008). Halving the square gives rectangles of area 1/16, and each
// of these holds one of the 16 points. `trees`: 15 random bits for either dimension.
uvec2 sobol_cell(uint index, bool last, uint trees) {
    uvec2 table_x = last ? uvec2(0x2AE64C80u, 0xB37FD519u) : uvec2(0xE6A2C480u, 0xF7B3D591u);
    uvec2 table_y = last ? uvec2(0x6EA24C80u, 0x3BF719D5u) : uvec2(0xE62A4C80u, 0x19D5B37Fu);
    uint x = owen_scramble(table_at(table_x, index), trees);
    uint y = owen_scramble(table_at(table_y, index), trees >> 15u);
    return uvec2(x, y);
}

// A random place in the cell: 16 bits for either dimension.
vec2 sobol_place(uvec2 cell, uint low) {
    uvec2 bits = (cell << 28u) | (uvec2(low, low >> 16u) & 0xFFFFu) << 12u;
    return vec2(unit_float(bits.x), unit_float(bits.y));
}
