// What a pixel has gathered: running means, so that any number of samples keeps its digits. A
// sample is an observation. The twin of shaders_glsl/film/pixel.glsl with BLOCK = 1.

struct Pixel {
    mean: vec3f,      // of the finite samples, radiance
    dropped: f32,     // samples that were not finite
    variance: vec3f,  // of the finite samples: mean squared deviation from their mean
    observations: f32,
}

fn empty_pixel() -> Pixel {
    return Pixel(vec3f(0.0), 0.0, vec3f(0.0), 0.0);
}

// By its bits: compilers may assume that no NaN exists.
fn is_finite(x: vec3f) -> bool {
    return all((bitcast<vec3u>(x) & vec3u(0x7F800000u)) != vec3u(0x7F800000u));
}

// The mean of `count` samples from that of all but x, m += (x - m) / n: a mix of m and x would
// drift (its weights do not add up to 1 in floating point). Steps are dithered.
fn next_mean(mean: vec3f, x: vec3f, count: f32) -> vec3f {
    let weight = 1.0 / count;
    let change = exact3(exact3(x - mean) * weight);
    let exponent = bitcast<vec3u>(mean) & vec3u(0x7F800000u);
    let last_place = bitcast<vec3f>(exponent) * 1.1920928955078125e-7;
    let moves = select(vec3f(0.0), vec3f(1.0), change != vec3f(0.0));
    let dither = exact3(golden_turn(u32(count)) * last_place * moves);
    return exact3(mean + exact3(change + dither));
}

// Adds the sample number `index`, from 0; the variance in Welford's form.
fn add_sample(pixel: ptr<function, Pixel>, x: vec3f, index: i32) {
    if (!is_finite(x)) {
        (*pixel).dropped += 1.0;
        return;
    }
    (*pixel).mean = next_mean((*pixel).mean, x, f32(index + 1) - (*pixel).dropped);
    (*pixel).observations += 1.0;
    let count = (*pixel).observations;
    if (count > 1.0) {
        let after = exact3(x - (*pixel).mean);
        let before = exact3(after * (count / (count - 1.0)));
        (*pixel).variance = next_mean((*pixel).variance, before * after, count);
    }
}
