// The kernel of trace.comp for OpenGL 4.1, which has no compute shaders. A fragment is a pixel of
// the tiles that trace.vert draws, and the target textures are those of a framebuffer.

#include "integrators/no_record.glsl"
#include "trace.glsl"
#include "passes/film_sources.glsl"

layout(location = 0) out vec4 target_mean;
layout(location = 1) out vec4 target_variance;
layout(location = 2) out vec4 target_block;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    Pixel pixel = load_pixel(texel);
    add_samples(pixel, frame.origin + texel);
    target_mean = vec4(pixel.mean, pixel.count);
    target_variance = vec4(pixel.variance, pixel.observations);
    target_block = vec4(pixel.block, pixel.begun);
}
