// Independent uniform numbers for one sample of one pixel, from the seed that the random texture
// holds for it. The twin of shaders_glsl/sampling/hash.glsl and sampler.glsl.

struct Sampler {
    seed: u32,
    dimension: u32,  // counts the numbers drawn
}

// The output permutation RXS-M-XS of PCG over one step of its generator (O'Neill 2014).
fn pcg_hash(x: u32) -> u32 {
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// 24 bits, so that the result is below 1.
fn unit_float(x: u32) -> f32 {
    return f32(x >> 8u) * 5.9604644775390625e-8;
}

// The n-th of numbers that fill [-1/2, 1/2) evenly however many there are: multiples of the golden
// ratio.
fn golden_turn(n: u32) -> f32 {
    return exact(unit_float(n * 0x9E3779B9u) - 0.5);
}

fn make_sampler(seed: u32) -> Sampler {
    return Sampler(seed, 0u);
}

fn next_1d(self_: ptr<function, Sampler>) -> f32 {
    (*self_).dimension += 0x9E3779B9u;
    return unit_float(pcg_hash((*self_).seed ^ (*self_).dimension));
}

fn next_2d(self_: ptr<function, Sampler>) -> vec2f {
    let x = next_1d(self_);
    let y = next_1d(self_);
    return vec2f(x, y);
}
