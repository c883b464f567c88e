// Adds samples to tiles of a crop of the frame, one tile per work group. Source and target are
// swapped when all tiles have the samples. Samples of one dispatch are added in registers, so that
// one dispatch of N samples equals N dispatches of one, bit for bit.

layout(local_size_x = 8, local_size_y = 8) in;

#include "integrators/no_record.glsl"
#include "trace.glsl"
#include "passes/tiles.glsl"

layout(rgba32f) uniform readonly image2D source_mean;      // a: finite samples
layout(rgba32f) uniform readonly image2D source_variance;  // a: observations
layout(rgba32f) uniform readonly image2D source_block;     // a: its samples
layout(rgba32f) uniform writeonly image2D target_mean;
layout(rgba32f) uniform writeonly image2D target_variance;
layout(rgba32f) uniform writeonly image2D target_block;
uniform sampler2D source_layers;  // a: its samples; OpenGL promises eight images, which the others are
layout(rgba32f) uniform writeonly image2D target_layers;
uniform isampler2D raster_hits;  // first surfaces: see raster.frag
layout(rgba32f) uniform writeonly image2D target_reservoirs;

layout(std430) buffer Lost { uint lost_samples; };

Pixel load_pixel(ivec2 texel) {
    if (frame.is_empty != 0) return empty_pixel();  // the source may hold anything
    vec4 mean = imageLoad(source_mean, texel);
    vec4 variance = imageLoad(source_variance, texel);
    vec4 block = vec4(0.0);
    if (BLOCK > 1) block = imageLoad(source_block, texel);
    return Pixel(mean.rgb, mean.a, variance.rgb, variance.a, block.rgb, block.a);
}

// Layers lie side by side: one half of the observations above, the other half below.
ivec2 layer_place(ivec2 texel, int slice) {
    return imageSize(target_mean) * ivec2(slice % DIVISOR, slice / DIVISOR) + texel;
}

Layers load_layers(ivec2 texel) {
    Layers layers = empty_layers();
    if (LAYERS == 0 || frame.is_empty != 0) return layers;
    for (int i = 0; i < 2 * LAYERS; i += 1) {
        vec4 mean = texelFetch(source_layers, layer_place(texel, i), 0);
        layers.means[i] = mean.rgb;
        layers.counts[i / DIVISOR] = mean.a;
    }
    return layers;
}

void store_layers(ivec2 texel, Layers layers) {
    if (LAYERS == 0) return;
    for (int i = 0; i < 2 * LAYERS; i += 1) {
        vec4 mean = vec4(layers.means[i], layers.counts[i / DIVISOR]);
        imageStore(target_layers, layer_place(texel, i), mean);
    }
}

void main() {
    ivec2 picture = imageSize(target_mean);
    ivec2 corner = tile_corner(picture, frame.first_tile + int(gl_WorkGroupID.x));
    ivec2 texel = corner + ivec2(gl_LocalInvocationID.xy);
    if (any(greaterThanEqual(texel, picture))) return;
    Pixel pixel = load_pixel(texel);
    Layers layers = load_layers(texel);
    if (RASTERS) keep_raster(texelFetch(raster_hits, texel, 0).xy);
    int lost = add_samples(pixel, layers, frame.origin + texel, frame.first_sample);
    if (MAY_LOSE && lost > 0) atomicAdd(lost_samples, uint(lost));
    imageStore(target_mean, texel, vec4(pixel.mean, pixel.count));
    imageStore(target_variance, texel, vec4(pixel.variance, pixel.observations));
    if (BLOCK > 1) imageStore(target_block, texel, vec4(pixel.block, pixel.begun));
    store_layers(texel, layers);
    if (!REUSES) return;
    for (int i = 0; i < PARTS_OF_RESERVOIR; i += 1) {
        imageStore(target_reservoirs, texel_of_part(texel, i), part_of_reservoir(held_reservoir, i));
    }
}
