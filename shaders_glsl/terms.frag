// The kernel of terms.comp for OpenGL 4.1, which has no compute shaders: see trace.frag. It keeps one term.

#include "integrators/no_record.glsl"
#include "trace.glsl"

uniform sampler2D source_mean;  // as in terms.comp
uniform sampler2D source_variance;
uniform sampler2D source_block;
layout(location = 0) out vec4 target_mean;
layout(location = 1) out vec4 target_variance;
layout(location = 2) out vec4 target_block;

const int KEPT_TERM = findLSB(LIGHT_TERMS);

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    term_pixels[KEPT_TERM] = empty_pixel();
    if (frame.is_empty == 0) {
        vec4 mean = texelFetch(source_mean, texel, 0);
        term_pixels[KEPT_TERM] = pixel_of(mean, texelFetch(source_variance, texel, 0));
        if (IN_PIECES) {
            vec4 begun = texelFetch(source_block, texel, 0);
            term_pixels[KEPT_TERM].block = begun.rgb;
            term_pixels[KEPT_TERM].begun = begun.a;
        }
    }
    Pixel whole = empty_pixel();
    add_samples(whole, frame.origin + texel);
    Pixel kept = term_pixels[KEPT_TERM];
    target_mean = vec4(kept.mean, kept.count);
    target_variance = vec4(kept.variance, kept.observations);
    target_block = vec4(kept.block, kept.begun);
}
