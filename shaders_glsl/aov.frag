// The kernel of aov.comp for OpenGL 4.1, which has no compute shaders: see trace.frag.

#include "aov.glsl"

uniform sampler2D source_mean;             // as in aov.comp
uniform sampler2D source_variance;
uniform sampler2D source_second_mean;
uniform sampler2D source_second_variance;
layout(location = 0) out vec4 target_mean;
layout(location = 1) out vec4 target_variance;
layout(location = 2) out vec4 target_second_mean;  // where IN_PIECES: the observation that has begun
layout(location = 3) out vec4 target_second_variance;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    Pixel first = empty_pixel();
    Pixel second = empty_pixel();
    if (frame.is_empty == 0) {
        first = pixel_of(texelFetch(source_mean, texel, 0), texelFetch(source_variance, texel, 0));
        if (IN_PIECES) {
            vec4 begun = texelFetch(source_second_mean, texel, 0);
            first.block = begun.rgb;
            first.begun = begun.a;
        }
        if (SECOND_AOV != NO_AOV) {
            second = pixel_of(texelFetch(source_second_mean, texel, 0), texelFetch(source_second_variance, texel, 0));
        }
    }
    add_aovs(first, second, frame.origin + texel);
    target_mean = vec4(first.mean, first.count);
    target_variance = vec4(first.variance, first.observations);
    target_second_mean = IN_PIECES ? vec4(first.block, first.begun) : vec4(second.mean, second.count);
    target_second_variance = vec4(second.variance, second.observations);
}
