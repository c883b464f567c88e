// Whether numbers are finite.

// Tests the bits: drivers may assume that no NaN exists and remove isnan.
bool is_finite(vec3 x) {
    uvec3 exponent = floatBitsToUint(x) & uvec3(0x7F800000u);
    return all(notEqual(exponent, uvec3(0x7F800000u)));
}
