// Uniform floats from hashes.

// 24 bits, so that the result is below 1: a 32-bit integer would be rounded up to it.
float unit_float(uint x) {
    float value = float(x >> 8u) * 5.9604644775390625e-8;
    return value;
}

// The n-th of numbers that fill [-1/2, 1/2) evenly, for any count of them: multiples of the golden
// ratio.
float golden_turn(uint n) {
    float turn = unit_float(n * 0x9E3779B9u) - 0.5;
    return turn;
}
