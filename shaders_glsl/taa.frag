// Temporal antialiasing (temporal/taa.glsl): the picture of the view before, kept near the values of the
// pixels around, blended with the film.

#include "temporal/taa.glsl"

uniform sampler2D light;    // the film under its weights
uniform sampler2D mean;     // of the film; a: finite samples
uniform sampler2D brought;  // history from reproject.frag
uniform bool has_history;
uniform float least;        // share of a new sample
uniform float reach;        // most distance of history from the mean around, in deviations; negative: no limit

out vec4 shown;             // radiance, and the samples that it stands for

vec3 kept_near(vec3 color, ivec2 texel) {
    if (reach < 0.0) return color;
    ivec2 last = textureSize(light, 0) - 1;
    vec3 sum = vec3(0.0);
    vec3 squares = vec3(0.0);
    for (int n = 0; n < 9; n += 1) {
        ivec2 near = clamp(texel + ivec2(n % 3 - 1, n / 3 - 1), ivec2(0), last);
        vec3 around = ycocg_of(texelFetch(light, near, 0).rgb);
        sum += around;
        squares += around * around;
    }
    vec3 middle = sum / 9.0;
    vec3 deviation = sqrt(max(squares / 9.0 - middle * middle, 0.0));
    return rgb_of(clipped(ycocg_of(color), middle, reach * deviation));
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec3 fresh = texelFetch(light, texel, 0).rgb;
    float count = texelFetch(mean, texel, 0).a;
    vec4 known = has_history ? texelFetch(brought, texel, 0) : vec4(0.0);
    shown = vec4(fresh, count);
    if (known.a <= 0.0) return;
    if (count > 0.0) known.rgb = kept_near(known.rgb, texel);
    shown = blended(known, fresh, count, least);
}
