// A hash of another family than that of hash.glsl, which it can replace. References of charts draw
// their numbers from it, so that no seed gives them the numbers of the pictures that they judge.

// Wellons, "Prospecting for Hash Functions" (2018): the constants of least bias found there.
uint pcg_hash(uint x) {
    x = (x ^ (x >> 16u)) * 0x7FEB352Du;
    x = (x ^ (x >> 15u)) * 0x846CA68Bu;
    return x ^ (x >> 16u);
}
