// The hash that all random numbers are made by.

// The output permutation RXS-M-XS of PCG over one step of its generator (O'Neill 2014;
// as a hash: Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 2020).
uint pcg_hash(uint x) {
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}
