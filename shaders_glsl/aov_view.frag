// An AOV as colours. Film row 0 is on top.

#include "passes/tonemap.glsl"
#include "passes/color_scale.glsl"
#include "sampling/hash.glsl"
#include "integrators/aov_numbers.glsl"

uniform sampler2D mean;   // of the AOV, as in aov.comp
uniform int part;         // of the `parts` that lie side by side in it
uniform int parts;
uniform int aov;
uniform vec3 eye;         // position of the camera, less whole cells
uniform float distance;   // depth along the view axis that is shown as middle grey
uniform float cell;       // edge of a cell: colours of the position repeat after it
uniform float most;       // number of bounces that gets the last colour
uniform vec3 colors[COLORS];  // for numbers of bounces, sRGB
uniform float exposure;       // of terms of light, EV
uniform int tonemap;

in vec2 place;
out vec4 color;

// The colour of an object. Neighbouring numbers get very different colours; none is dark.
vec3 color_of_object(uint number) {
    uint bits = pcg_hash(number);
    vec3 share = vec3(uvec3(bits, bits >> 8, bits >> 16) & 255u) / 255.0;
    return 0.25 + 0.75 * share;
}

vec3 color_of(vec4 value) {
    if (aov == ALBEDO) return encode_srgb(clamp(value.rgb, 0.0, 1.0));
    if (aov == NORMAL) return 0.5 + 0.5 * value.rgb;
    if (value.a == 0.0) return vec3(0.0);  // the ray met nothing
    if (aov == BOUNCES) return color_at(colors, value.r / most);
    if (aov == DEPTH) return vec3(distance / (distance + max(value.r, 0.0)));
    if (aov == POSITION) return fract((value.rgb + eye) / cell);
    if (aov >= EMISSION && aov <= VOLUME) return expose_and_encode(value.rgb, exposure, tonemap);
    if (aov == OBJECT && value.r > 0.0) return color_of_object(uint(value.r));
    return vec3(0.0);
}

void main() {
    ivec2 size = textureSize(mean, 0) / ivec2(parts, 1);
    ivec2 texel = min(ivec2(place * vec2(size)), size - 1) + ivec2(part * size.x, 0);
    color = vec4(color_of(texelFetch(mean, texel, 0)), 1.0);
}
