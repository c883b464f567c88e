// The film on a screen: exposed, tone-mapped, sRGB. Film row 0 is on top.

#include "passes/tonemap.glsl"

uniform sampler2D picture;
uniform float exposure;  // EV
uniform int tonemap;

in vec2 place;
out vec4 color;

void main() {
    vec2 size = vec2(textureSize(picture, 0));
    ivec2 texel = min(ivec2(place * size), ivec2(size) - 1);
    vec3 radiance = texelFetch(picture, texel, 0).rgb;
    vec3 encoded = expose_and_encode(radiance, exposure, tonemap);
    color = vec4(floor(255.0 * encoded + 0.5) / 255.0, 1.0);  // drivers differ in how they round to 8 bits
}
