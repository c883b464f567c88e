// The kernel of aov.comp for OpenGL 4.1, which has no compute shaders: see trace.frag.

#include "aov.glsl"
#include "passes/aov_sources.glsl"

layout(location = 0) out vec4 target_mean;
layout(location = 1) out vec4 target_variance;
layout(location = 2) out vec4 target_second_mean;
layout(location = 3) out vec4 target_second_variance;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    Pixel first = load_first(texel);
    Pixel second = load_second(texel);
    add_aovs(first, second, frame.origin + texel);
    target_mean = vec4(first.mean, first.count);
    target_variance = vec4(first.variance, first.observations);
    target_second_mean = vec4(second.mean, second.count);
    target_second_variance = vec4(second.variance, second.observations);
}
