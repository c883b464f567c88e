// Statistics of a pixel: running means, so that any number of samples keeps its digits.
//
// The error is computed over observations, which are independent of each other: one sample each, or
// BLOCK samples whose points belong together. Where IS_SHARED, `block` is the mean of a group of blocks, which goes on
// from dispatch to dispatch (glrt/rendering/film.py), and errors are computed from all groups.

struct Pixel {
    vec3 mean;           // of the finite samples, radiance
    float count;         // number of the finite samples; others are not finite, or lost to the loop limit
    vec3 variance;       // of the observations: mean squared deviation from their mean
    float observations;
    vec3 block;          // mean of the finite samples of the observation that has begun
    float begun;         // number of those samples
};

Pixel empty_pixel() {
    return Pixel(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
}

// A pixel as stored between dispatches; no observation goes on from one to the next.
Pixel pixel_of(vec4 mean, vec4 variance) {
    return Pixel(mean.rgb, mean.a, variance.rgb, variance.a, vec3(0.0), 0.0);
}

// The mean of `count` samples from the mean of all but x, m += (x - m) / n. A mix of m and x would drift,
// since its weights do not add up to 1 in floating point. A late step is a few units in the last place
// of m. If it were always rounded the same way, the mean of an edge, where samples have two values, would
// be off by ten times its noise after 2^20 samples. So steps are dithered.
vec3 next_mean(vec3 mean, vec3 x, float count) {
    float weight = 1.0 / count;
    vec3 step = (x - mean) * weight;
    uvec3 exponent = floatBitsToUint(mean) & uvec3(0x7F800000u);
    vec3 last_place = uintBitsToFloat(exponent) * 1.1920928955078125e-7;
    vec3 dither = golden_turn(uint(count)) * last_place * vec3(notEqual(step, vec3(0.0)));
    vec3 next = mean + (step + dither);
    return next;
}

// Welford's form, after the mean has moved by its share of the observation x: x less the mean
// before equals x less the mean now, times n / (n - 1).
void end_observation(inout Pixel pixel) {
    pixel.observations += 1.0;
    if (pixel.observations > 1.0) {
        float count = pixel.observations;
        vec3 after = pixel.block - pixel.mean;
        vec3 before = after * (count / (count - 1.0));
        pixel.variance = next_mean(pixel.variance, before * after, count);
    }
    pixel.block = vec3(0.0);
    pixel.begun = 0.0;
}

// Adds the sample number `index`, from 0; a sample that is not finite is left out.
void add_sample(inout Pixel pixel, vec3 x, int index) {
    if (is_finite(x)) {
        pixel.count += 1.0;
        pixel.mean = next_mean(pixel.mean, x, pixel.count);
        pixel.begun += 1.0;
        pixel.block = BLOCK > 1 ? next_mean(pixel.block, x, pixel.begun) : x;
    }
    if (!IS_SHARED && (index + 1) % BLOCK == 0 && pixel.begun > 0.0) end_observation(pixel);
}

// Drops the samples from number `index` to before `end`, which are lost: an observation among them may end.
void drop_samples(inout Pixel pixel, int index, int end) {
    if (!IS_SHARED && end / BLOCK > index / BLOCK && pixel.begun > 0.0) end_observation(pixel);
}
