// Adds samples to tiles of a crop of the frame, one tile a work group. Source and target are
// swapped when all tiles have them; the samples of one dispatch go through registers, so that
// one dispatch of N equals N of one, bit for bit.

layout(local_size_x = 8, local_size_y = 8) in;

#include "scene.glsl"
#include "blocks.glsl"
#include "rng.glsl"
#include "sobol.glsl"
#include "sampler.glsl"
#include "warp.glsl"
#include "camera.glsl"
#include "shape.glsl"
#include "material.glsl"
#include "strips.glsl"
#include "light.glsl"
#include "path.glsl"
#include "film.glsl"
#include "samples.glsl"

layout(rgba32f) uniform readonly image2D source_mean;      // a: dropped samples
layout(rgba32f) uniform readonly image2D source_variance;  // a: observations
layout(rgba32f) uniform readonly image2D source_block;     // a: its samples
layout(rgba32f) uniform writeonly image2D target_mean;
layout(rgba32f) uniform writeonly image2D target_variance;
layout(rgba32f) uniform writeonly image2D target_block;

Pixel load_pixel(ivec2 texel) {
    if (frame.first_sample == 0) return empty_pixel();  // whatever the source holds
    vec4 mean = imageLoad(source_mean, texel);
    vec4 variance = imageLoad(source_variance, texel);
    vec4 block = vec4(0.0);
    if (BLOCK > 1) block = imageLoad(source_block, texel);
    return Pixel(mean.rgb, mean.a, variance.rgb, variance.a, block.rgb, block.a);
}

// Tiles are numbered along rows, `tile_stride` apart: those of one dispatch lie all over the
// picture, and each dispatch costs about the same.
ivec2 texel_of_lane() {
    uvec2 size = gl_WorkGroupSize.xy;
    uvec2 tiles = (uvec2(imageSize(target_mean)) + size - 1u) / size;
    uint number = uint(frame.first_tile) + gl_WorkGroupID.x;
    uint tile = number * uint(frame.tile_stride) % (tiles.x * tiles.y);
    uvec2 corner = size * uvec2(tile % tiles.x, tile / tiles.x);
    return ivec2(corner + gl_LocalInvocationID.xy);
}

void main() {
    ivec2 texel = texel_of_lane();
    if (any(greaterThanEqual(texel, imageSize(target_mean)))) return;
    Pixel pixel = load_pixel(texel);
    add_samples(pixel, frame.origin + texel);
    imageStore(target_mean, texel, vec4(pixel.mean, pixel.dropped));
    imageStore(target_variance, texel, vec4(pixel.variance, pixel.observations));
    if (BLOCK > 1) imageStore(target_block, texel, vec4(pixel.block, pixel.begun));
}
