// The models of another view (temporal/wrls_rows.glsl), moved to this view: each from the nearest pixel that
// showed the same surface. They are not interpolated between pixels: slopes of two fits have no mean.

uniform sampler2D position;         // as in reproject.frag
uniform sampler2D normal;
uniform sampler2D before_position;
uniform sampler2D before_normal;
uniform vec3 eye_shift;
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

uniform sampler2D known_row[7];  // of the models of the view before

layout(location = 0) out vec4 unused;
layout(location = 1) out vec4 row[7];  // zeros where the surface was not seen

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(position, texel, 0);
    vec4 facing = facing_before(texel, surface, texelFetch(normal, texel, 0));
    vec3 seen = seen_before(texel, surface);
    vec2 place = place_before(seen);
    ivec2 source = NO_TEXEL;
    if (place != NO_PLACE && !has_flag(facing, LAMP_EDGE)) source = texel_at(place, surface.w, seen, facing);
    unused = vec4(0.0);
    for (int j = 0; j < 7; j += 1) row[j] = source == NO_TEXEL ? vec4(0.0) : texelFetch(known_row[j], source, 0);
}
