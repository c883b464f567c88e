// Adaptive temporal antialiasing (temporal/ataa.glsl): shows each pixel by the method of its mask.

#include "temporal/taa.glsl"
#include "temporal/ataa.glsl"

uniform sampler2D light;  // the film under its weights
uniform sampler2D mean;   // of the film; a: finite samples
uniform sampler2D plain;  // picture of temporal antialiasing, a: samples
uniform sampler2D mask;
uniform sampler2D more;   // for traced pixels: radiance, and samples
uniform bool has_more;
uniform float least;      // share of a new sample

out vec4 shown;           // radiance, and the samples that it stands for

// The film, mapped, interpolated between texels; `at` in texels, their middles at halves.
vec3 film_at(vec2 at) {
    ivec2 last = textureSize(light, 0) - 1;
    vec2 from_middle = at - 0.5;
    ivec2 corner = ivec2(floor(from_middle));
    vec2 share = from_middle - vec2(corner);
    vec3 sum = vec3(0.0);
    for (int n = 0; n < 4; n += 1) {
        ivec2 side = ivec2(n & 1, n >> 1);
        vec2 parts = mix(1.0 - share, share, vec2(side));
        ivec2 texel = clamp(corner + side, ivec2(0), last);
        sum += parts.x * parts.y * mapped_of(texelFetch(light, texel, 0).rgb);
    }
    return sum;
}

float luma_at(vec2 at) {
    float luma = dot(film_at(at), vec3(0.299, 0.587, 0.114));
    return luma;
}

vec3 filtered(vec2 at) {
    vec3 middle = film_at(at);
    float here = luma_at(at);
    float nw = luma_at(at + vec2(-0.5, -0.5));
    float ne = luma_at(at + vec2(0.5, -0.5));
    float sw = luma_at(at + vec2(-0.5, 0.5));
    float se = luma_at(at + vec2(0.5, 0.5));
    float lowest = min(here, min(min(nw, ne), min(sw, se)));
    float highest = max(here, max(max(nw, ne), max(sw, se)));
    if (highest - lowest < max(LEAST_RANGE, RANGE_SHARE * highest)) return middle;
    vec2 along = vec2(sw + se - nw - ne, nw + sw - ne - se);
    float bias = max(0.25 * (nw + ne + sw + se) * FLATTEST, LEAST_BIAS);
    along = clamp(along / (min(abs(along.x), abs(along.y)) + bias), -LONGEST, LONGEST);
    vec3 inner = 0.5 * (film_at(at - along / 6.0) + film_at(at + along / 6.0));
    vec3 outer = 0.5 * inner + 0.25 * (film_at(at - 0.5 * along) + film_at(at + 0.5 * along));
    float luma = dot(outer, vec3(0.299, 0.587, 0.114));
    return luma < lowest || luma > highest ? inner : outer;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    int found = int(texelFetch(mask, texel, 0).a);
    float count = texelFetch(mean, texel, 0).a;
    shown = texelFetch(plain, texel, 0);
    if (found == FILTERED && count > 0.0) {
        shown.rgb = unmapped(filtered(vec2(texel) + 0.5));
    }
    if (found < TRACED || !has_more) return;
    vec4 extra = texelFetch(more, texel, 0);
    float samples = count + extra.a;
    if (samples <= 0.0) return;
    vec3 fresh = (count * texelFetch(light, texel, 0).rgb + extra.a * extra.rgb) / samples;
    vec4 known = vec4(shown.rgb, shown.a - count);
    shown = vec4(fresh, samples);
    if (found == TRACED && known.a > 0.0) {
        float share = max(samples / (known.a + samples), share_of(count, known.a, least));
        shown = vec4(known.rgb + share * (fresh - known.rgb), known.a + samples);
    }
}
