// What a pixel has gathered: running means, so that any number of samples keeps its digits.

struct Pixel {
    vec3 mean;       // of the finite samples, radiance
    float dropped;   // samples that were not finite
    vec3 variance;   // of the finite samples: mean squared deviation from their mean
};

Pixel empty_pixel() {
    return Pixel(vec3(0.0), 0.0, vec3(0.0));
}

// By its bits: drivers may assume that no NaN exists and fold isnan away.
bool is_finite(vec3 x) {
    uvec3 exponent = floatBitsToUint(x) & uvec3(0x7F800000u);
    return all(notEqual(exponent, uvec3(0x7F800000u)));
}

// Adds the sample number `index` (from 0) in Welford's form, m += (x - m) / n: a mix of m and x
// would drift (its weights do not add up to 1 in floating point).
void add_sample(inout Pixel pixel, vec3 x, int index) {
    if (!is_finite(x)) {
        pixel.dropped += 1.0;
        return;
    }
    float count = float(index + 1) - pixel.dropped;
    if (count == 1.0) {
        pixel.mean = x;
        pixel.variance = vec3(0.0);
        return;
    }
    float weight = 1.0 / count;
    vec3 before = x - pixel.mean;
    vec3 mean = pixel.mean + before * weight;
    vec3 after = x - mean;
    vec3 change = (before * after - pixel.variance) * weight;
    pixel.mean = mean;
    pixel.variance += change;
}
