// The exponential function of what falls off.

const float MOST_DEPTH = 87.0;  // exp(-depth) beyond it is no normal float

// exp(-depth), which differs between drivers: 2^-n times a polynomial of the rest. The rest is n ln 2 - depth, at
// most half of ln 2 in size. Taylor's polynomial of degree 7 is right to 5e-9. ln 2 stands in two parts, the first
// of 9 bits.
float decay(float depth) {
    if (depth > MOST_DEPTH) return 0.0;
    float n = floor(depth * 1.44269504 + 0.5);
    float rest = n * 0.693359375 - depth;
    rest -= n * 2.12194440e-4;
    float p = 1.0 / 720.0 + rest / 5040.0;
    p = p * rest + 1.0 / 120.0;
    p = p * rest + 1.0 / 24.0;
    p = p * rest + 1.0 / 6.0;
    p = p * rest + 0.5;
    float sum = 1.0 + rest + rest * rest * p;
    float left = sum * uintBitsToFloat(uint(127 - int(n)) << 23);
    return left;
}
