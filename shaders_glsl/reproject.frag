// The history of another view, moved to this view: radiance, and the samples that it stands for.

uniform sampler2D position;         // of this view
uniform sampler2D normal;
uniform sampler2D before_position;  // of the view before
uniform sampler2D before_normal;
uniform vec3 eye_shift;             // from the eye before to the eye now
uniform vec3 before_right;          // of the camera before: half the width and height of the frame, at distance 1
uniform vec3 before_up;
uniform vec3 before_forward;        // unit
uniform vec2 before_frame;          // size of its full frame, pixels
uniform vec2 before_origin;         // origin of its crop
uniform sampler2D motion;           // objects that moved (glrt/rendering/history/motion.py)
uniform int moved;                  // its rows
uniform sampler2D deformed;         // places before of deformed surfaces (deformed.frag)
uniform sampler2D deformed_normal;  // their normals

#include "passes/reprojection.glsl"

uniform sampler2D history;     // picture that was shown of the view before
uniform float most;            // samples that history may stand for
uniform float most_specular;   // the same in mirrors and glass, and out of focus
uniform float most_at_edges;  // the same where samples may meet another surface, too
uniform float most_at_lamps;  // the same at edges of lamps; 0: no history there
uniform float density;         // pixels of the view before for each pixel of this view, at most 1

out vec4 brought;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(position, texel, 0);
    vec4 facing = facing_before(texel, surface, texelFetch(normal, texel, 0));
    vec3 seen = seen_before(texel, surface);
    vec2 place = place_before(seen);
    brought = vec4(0.0);
    if (place == NO_PLACE || (most_at_lamps <= 0.0 && has_flag(facing, LAMP_EDGE))) return;
    vec4 found = history_at(history, place, surface.w, seen, facing);
    float limit = has_flag(facing, SPECULAR | BLURRED) ? most_specular : most;
    if (has_flag(facing, EDGE)) limit = min(limit, most_at_edges);
    if (has_flag(facing, LAMP_EDGE)) limit = min(limit, most_at_lamps);
    brought = vec4(found.rgb, min(density * found.a, limit));
}
