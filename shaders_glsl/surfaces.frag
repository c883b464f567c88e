// The kernel of surfaces.comp for OpenGL 4.1, which has no compute shaders: see trace.frag.

#include "surfaces.glsl"

layout(location = 0) out vec4 target_position;
layout(location = 1) out vec4 target_normal;

void main() {
    MiddleSurface found = middle_surface(frame.origin + ivec2(gl_FragCoord.xy));
    target_position = found.position;
    target_normal = found.normal;
}
