// Uniform numbers for one sample of one pixel. The thesis keeps the seed in a texture of the frame's
// size and refreshes it every frame; here it is hashed from the pixel. The dimension counts the
// numbers drawn.
//
// The numbers are independent or, where BLOCK is above 1, points of a net of BLOCK points (16: sampling/sobol.glsl,
// more: sampling/net.glsl). Each block of BLOCK samples has its own scramble. Where IS_SHARED, each even block has the
// same numbers in all pixels. Particles, whose places are below 0, always have their own.

const uint STEP = 0x9E3779B9u;  // from one dimension to the next

struct Sampler {
    uint seed;
    uint dimension;
    uint block;  // seed of the block
    uint point;  // number of the sample in it
};

// Pixel, sample and seed are hashed together: `hash(pixel) + sample` would give neighbours
// the same sequence shifted by one.
uint pixel_seed(ivec2 pixel, int sample_index, uint seed) {
    uint frame = pcg_hash(uint(sample_index) + pcg_hash(seed));
    return pcg_hash(uint(pixel.x) + pcg_hash(uint(pixel.y) + frame));
}

Sampler make_sampler(uint seed) {
    return Sampler(seed, 0u, 0u, 0u);
}

// The sampler of the sample `index`, from 0, of a pixel.
Sampler sampler_at(ivec2 pixel, int index, uint seed) {
    if (IS_SHARED && pixel.y >= 0 && index / BLOCK % 2 == 0) pixel = ivec2(0);
    Sampler rng = make_sampler(pixel_seed(pixel, index, seed));
    if (BLOCK > 1) {
        rng.block = pixel_seed(pixel, index / BLOCK, ~seed);  // differs from the seeds of all samples
        rng.point = uint(index % BLOCK);
    }
    return rng;
}

// Independent numbers in addition to those of a sample, a row for each `number`: for choices that are no draws of a
// path.
Sampler sampler_beside(Sampler self, int number) {
    return make_sampler(pcg_hash(~self.seed + pcg_hash(uint(number))));
}

float next_independent(inout Sampler self) {
    self.dimension += STEP;
    return unit_float(pcg_hash(self.seed ^ self.dimension));
}

// The same as next_sobol, for blocks of 64 samples or more.
vec2 next_of_net(Sampler self, uint first, bool last) {
    uvec2 point = net_point(net_order(self.point, pcg_hash(self.block ^ first)), last);
    uint random = pcg_hash(~self.block ^ self.dimension);
    uint more = BLOCK > 256 ? pcg_hash(random) : random >> 16u;  // 32 bits are those of two scrambles of 8 digits
    point.x = scrambled(point.x, random, random >> (BLOCK > 256 ? 16u : 8u));
    point.y = scrambled(point.y, more, more >> (BLOCK > 256 ? 16u : 8u));
    return net_place(point, pcg_hash(self.seed ^ self.dimension));
}

// Two successive draws share one shuffled point of four dimensions.
vec2 next_sobol(inout Sampler self) {
    self.dimension += STEP;
    bool last = (self.dimension & 1u) == 0u;  // STEP is odd: true for every second draw
    uint first = last ? self.dimension - STEP : self.dimension;
    if (BLOCK > 16) return next_of_net(self, first, last);
    uint index = owen_scramble(self.point, pcg_hash(self.block ^ first));
    uvec2 cell = sobol_cell(index, last, pcg_hash(~self.block ^ self.dimension));
    return sobol_place(cell, pcg_hash(self.seed ^ self.dimension));
}

float next_1d(inout Sampler self) {
    if (BLOCK > 1) return next_sobol(self).x;
    return next_independent(self);
}

vec2 next_2d(inout Sampler self) {
    if (BLOCK > 1) return next_sobol(self);
    float x = next_independent(self);
    float y = next_independent(self);
    return vec2(x, y);
}
