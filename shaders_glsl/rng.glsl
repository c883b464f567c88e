// Hashes of 32-bit integers and their use as uniform floats.

// The output permutation RXS-M-XS of PCG over one step of its generator (O'Neill 2014;
// as a hash: Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 2020).
uint pcg_hash(uint x) {
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// 24 bits, so that the result is below 1 (a 32-bit integer would round up to it).
float unit_float(uint x) {
    return float(x >> 8u) * 5.9604644775390625e-8;
}

// The n-th of numbers that fill [-1/2, 1/2) evenly however many there are: multiples of the golden
// ratio.
float golden_turn(uint n) {
    float turn = unit_float(n * 0x9E3779B9u) - 0.5;
    return turn;
}
