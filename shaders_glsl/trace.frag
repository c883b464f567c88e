// The kernel of trace.comp for OpenGL 4.1, which has no compute shaders. A fragment is a pixel of
// the tiles that trace.vert draws, and the target textures are those of a framebuffer.

#include "integrators/no_record.glsl"
#include "trace.glsl"

uniform sampler2D source_mean;      // as in trace.comp
uniform sampler2D source_variance;
uniform sampler2D source_block;
uniform isampler2D raster_hits;
layout(location = 0) out vec4 target_mean;
layout(location = 1) out vec4 target_variance;
layout(location = 2) out vec4 target_block;

Pixel load_pixel(ivec2 texel) {
    if (frame.is_empty != 0) return empty_pixel();
    vec4 mean = texelFetch(source_mean, texel, 0);
    vec4 variance = texelFetch(source_variance, texel, 0);
    vec4 block = vec4(0.0);
    if (BLOCK > 1) block = texelFetch(source_block, texel, 0);
    return Pixel(mean.rgb, mean.a, variance.rgb, variance.a, block.rgb, block.a);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    Pixel pixel = load_pixel(texel);
    if (RASTERS) keep_raster(texelFetch(raster_hits, texel, 0).xy);
    add_samples(pixel, frame.origin + texel);
    target_mean = vec4(pixel.mean, pixel.count);
    target_variance = vec4(pixel.variance, pixel.observations);
    target_block = vec4(pixel.block, pixel.begun);
}
