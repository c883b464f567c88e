// A net of up to 2^16 points in four dimensions, Owen-scrambled. Each number of first points that is a power of two is a
// net by itself, so it may grow.
//
// Owen's scramble flips each binary digit by a random bit that depends on the digits before it. A hash whose bits depend
// on lower bits alone does that to numbers with their digits in reverse: Burley ("Practical Hash-based Owen Scrambling",
// JCGT 2020), with the constants of Vegdahl ("Building a Better LK Hash", 2021). Points are shuffled by scrambling their
// numbers, as in sampling/sobol.glsl.

const int NET_POINTS = 1 << 16;

// Scrambles digits that stand in reverse, the first one in the lowest bit. Digits that v lacks become random, too.
uint owen_hash(uint v, uint seed) {
    v ^= v * 0x3D20ADEAu;
    v += seed;
    v *= (seed >> 16u) | 1u;
    v ^= v * 0x05526C56u;
    v ^= v * 0x53A22864u;
    return v;
}

// The number of a point after the shuffle.
uint net_order(uint point, uint seed) {
    return bitfieldReverse(owen_hash(bitfieldReverse(point) >> 16u, seed)) >> 16u;
}

// A point in two of four dimensions, the first two or the last two, digits in reverse. The first two are Sobol's: the
// digits of the number, and Pascal's triangle modulo 2 times these. The last two are the same in a linear order of the
// points, found by a search: up to 2^10 points, the four dimensions have t of at most 3, as Sobol's have.
uvec2 net_point(uint index, bool last) {
    if (last) {
        index ^= (index >> 1u) & 0x547Fu;
        index ^= (index >> 3u) & 0xC35u;
        index ^= (index >> 5u) & 0x6F7u;
    }
    uint y = index ^ ((index >> 1u) & 0x5555u);
    y ^= (y >> 2u) & 0x3333u;
    y ^= (y >> 4u) & 0x0F0Fu;
    y ^= (y >> 8u) & 0x00FFu;
    return uvec2(index, y);
}

vec2 net_place(uvec2 point, uvec2 seeds) {
    float x = unit_float(bitfieldReverse(owen_hash(point.x, seeds.x)));
    float y = unit_float(bitfieldReverse(owen_hash(point.y, seeds.y)));
    return vec2(x, y);
}
