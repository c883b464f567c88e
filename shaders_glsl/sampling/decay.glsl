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

// The natural logarithm of a normal float above 0: a multiple of ln 2, and the series of the area hyperbolic tangent.
// Its error is 2e-7 where the logarithm is below 1 in size, and relative to it beyond.
float ln(float x) {
    uint bits = floatBitsToUint(x);
    int n = int(bits >> 23) - 127;
    float m = uintBitsToFloat((bits & 0x7fffffu) | 0x3f800000u);
    if (m > 1.41421356) {
        m *= 0.5;
        n += 1;
    }
    float s = (m - 1.0) / (m + 1.0);
    float s2 = s * s;
    float p = 1.0 / 7.0 + s2 / 9.0;
    p = p * s2 + 0.2;
    p = p * s2 + 1.0 / 3.0;
    float sum = 2.0 * s * (1.0 + s2 * p);
    float found = float(n) * 0.69314718 + sum;
    return found;
}
