
// Adds samples to the pixels of a list, each from its own next sample on: trace.comp for pictures whose
// pixels have counts of their own (glrt/rendering/adaptive_tracer.py). Source and target may be one
// texture: a pixel reads and writes its own texel alone.

layout(local_size_x = 64) in;

#include "integrators/no_record.glsl"
#include "trace.glsl"

layout(rgba32f) uniform readonly image2D source_mean;  // as in trace.comp
layout(rgba32f) uniform readonly image2D source_variance;
layout(rgba32f) uniform readonly image2D source_block;
layout(rgba32f) uniform writeonly image2D target_mean;
layout(rgba32f) uniform writeonly image2D target_variance;
layout(rgba32f) uniform writeonly image2D target_block;

// The first `listed` pixels get samples: x + width y, and samples that the pixel had before those of the frame.
layout(std430) readonly buffer List { uint listed; uint reserved; uvec2 pixels[]; };
layout(std430) buffer Lost { uint lost_samples; };

Pixel load_pixel(ivec2 texel) {
    if (frame.is_empty != 0) return empty_pixel();  // the source may hold anything
    vec4 mean = imageLoad(source_mean, texel);
    vec4 variance = imageLoad(source_variance, texel);
    vec4 block = vec4(0.0);
    if (BLOCK > 1) block = imageLoad(source_block, texel);
    return Pixel(mean.rgb, mean.a, variance.rgb, variance.a, block.rgb, block.a);
}

void main() {
    uint row = uint(64 * frame.first_tile) + gl_GlobalInvocationID.x;
    if (row >= listed || frame.sample_count == 0) return;
    int width = imageSize(target_mean).x;
    ivec2 texel = ivec2(int(pixels[row].x) % width, int(pixels[row].x) / width);
    Pixel pixel = load_pixel(texel);
    Layers layers = empty_layers();
    int lost = add_samples(pixel, layers, frame.origin + texel, frame.first_sample + int(pixels[row].y));
    if (MAY_LOSE && lost > 0) atomicAdd(lost_samples, uint(lost));
    imageStore(target_mean, texel, vec4(pixel.mean, pixel.count));
    imageStore(target_variance, texel, vec4(pixel.variance, pixel.observations));
    if (BLOCK > 1) imageStore(target_block, texel, vec4(pixel.block, pixel.begun));
}
