// Independent uniform numbers for one sample of one pixel. The seed is what the thesis keeps in
// a texture of the frame's size and refreshes every frame; here it is hashed from its place.
// The dimension counts the numbers drawn.

struct Sampler {
    uint seed;
    uint dimension;
};

// Pixel, sample and seed are hashed together: `hash(pixel) + sample` would give neighbours
// the same sequence shifted by one.
uint pixel_seed(ivec2 pixel, int sample_index, uint seed) {
    uint frame = pcg_hash(uint(sample_index) + pcg_hash(seed));
    return pcg_hash(uint(pixel.x) + pcg_hash(uint(pixel.y) + frame));
}

Sampler make_sampler(uint seed) {
    return Sampler(seed, 0u);
}

float next_1d(inout Sampler self) {
    self.dimension += 0x9E3779B9u;
    return unit_float(pcg_hash(self.seed ^ self.dimension));
}

vec2 next_2d(inout Sampler self) {
    float x = next_1d(self);
    float y = next_1d(self);
    return vec2(x, y);
}
