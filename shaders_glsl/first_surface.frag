// The first surface behind each pixel under a lamp at the eye: its albedo, shaded by its normal.
// Film row 0 is on top.

#include "passes/tonemap.glsl"

const float AMBIENT = 0.3;  // share of the light that comes from all directions
const vec3 NOTHING = vec3(0.18);  // linear colour where the ray meets no surface

uniform sampler2D albedo;  // means of AOVs, as in aov.comp
uniform sampler2D normal;
uniform vec3 right;        // of the camera: half the width and height of the frame, at distance 1
uniform vec3 up;
uniform vec3 forward;

in vec2 place;
out vec4 color;

void main() {
    ivec2 size = textureSize(albedo, 0);
    ivec2 texel = min(ivec2(place * vec2(size)), size - 1);
    vec3 direction = forward + (2.0 * place.x - 1.0) * right + (1.0 - 2.0 * place.y) * up;
    vec3 unit_normal = texelFetch(normal, texel, 0).rgb;
    float facing = max(-dot(unit_normal, normalize(direction)), 0.0);
    vec3 light = texelFetch(albedo, texel, 0).rgb * (AMBIENT + (1.0 - AMBIENT) * facing);
    bool is_met = unit_normal != vec3(0.0);
    color = vec4(encode_srgb(clamp(is_met ? light : NOTHING, 0.0, 1.0)), 1.0);
}
