// The normals of surfaces.glsl, with EDGE among their flags where samples of a pixel may meet several surfaces.
// There, one of the pixels around is of another object, or off the plane of the surface. If one of these surfaces is a
// lamp, the flags also contain LAMP_EDGE. A cloud fades into what is around it, and has no edge of its own.

#include "passes/surface_flags.glsl"

uniform sampler2D position;
uniform sampler2D normal;

out vec4 marked;

const float OFF_PLANE = 0.02;  // of the distance from the eye

bool is_other(vec4 middle, vec3 facing, vec4 around) {
    if (around.w != middle.w) return true;
    if (middle.w <= 0.0) return false;
    float off = abs(dot(around.xyz - middle.xyz, facing));
    return off > OFF_PLANE * length(middle.xyz);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(position, 0) - 1;
    vec4 middle = texelFetch(position, texel, 0);
    marked = texelFetch(normal, texel, 0);
    if (has_flag(marked, CLOUD)) return;
    bool is_edge = false;
    bool has_lamp = has_flag(marked, LAMP);
    for (int n = 0; n < 9; n += 1) {
        ivec2 near = clamp(texel + ivec2(n % 3 - 1, n / 3 - 1), ivec2(0), last);
        if (!is_other(middle, marked.xyz, texelFetch(position, near, 0))) continue;
        is_edge = true;
        has_lamp = has_lamp || has_flag(texelFetch(normal, near, 0), LAMP);
    }
    if (is_edge) marked.w += float(has_lamp ? EDGE + LAMP_EDGE : EDGE);
}
