// The mask of pixels where an exponential mean over views fails (temporal/ataa.glsl).

uniform sampler2D position;         // of this view
uniform sampler2D normal;
uniform sampler2D before_position;  // of the view before
uniform sampler2D before_normal;
uniform vec3 eye_shift;             // from here on as in reproject.frag
uniform vec3 before_right;
uniform vec3 before_up;
uniform vec3 before_forward;
uniform vec2 before_frame;
uniform vec2 before_origin;
uniform sampler2D motion;
uniform int moved;
uniform sampler2D deformed;
uniform sampler2D deformed_normal;

#include "passes/reprojection.glsl"
#include "temporal/ataa.glsl"

uniform sampler2D light;    // the film under its weights
uniform sampler2D brought;  // history from reproject.frag

out vec4 mask;              // a: the number of what a pixel shows (temporal/ataa.glsl)

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(light, 0) - 1;
    vec4 facing = texelFetch(normal, texel, 0);
    vec2 place = place_before(seen_before(texel, texelFetch(position, texel, 0)));
    vec4 known = texelFetch(brought, texel, 0);
    float least = 1.0;
    float most = 0.0;
    for (int n = 0; n < 9; n += 1) {
        ivec2 near = clamp(texel + ivec2(n % 3 - 1, n / 3 - 1), ivec2(0), last);
        float luma = luma_of(texelFetch(light, near, 0).rgb);
        least = min(least, luma);
        most = max(most, luma);
    }
    float luma = luma_of(known.rgb);
    float off = max(max(least - luma, luma - most), 0.0);
    int found = failure_of(vec2(texel) + 0.5, place, known.a, off, most - least,
                           has_flag(facing, EDGE), has_flag(facing, SPECULAR));
    mask = vec4(off, most - least, known.a, float(found));
}
