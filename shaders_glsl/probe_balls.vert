// A square around the ball of each probe that is used, as a strip of four vertices; below them, one over the whole
// screen.

struct ProbeGrid {
    vec3 probe_first;
    vec3 probe_cell;
    ivec3 probe_counts;
};
uniform ProbeGrid frame;
uniform sampler2D probe_light;  // maps: see probes/maps.glsl
uniform sampler2D probe_distances;
uniform sampler2D probe_places;
uniform vec3 right;    // of the camera: half the width and height of the frame, at distance 1
uniform vec3 up;
uniform vec3 forward;  // unit
uniform float radius;  // of a ball

#include "passes/probe_balls.glsl"

in int number;  // of a probe; -1: the whole screen

const float NEAREST = 1.25;  // in radii: the least distance of a drawn ball before the eye

flat out int probe;
out vec2 place;  // on the screen, from -1 to 1; upwards

// The ends of a ball along one axis of the screen, at distance 1, from left to right (Mara and McGuire, "2D Polyhedral
// Bounds of a Clipped, Perspective-Projected 3D Sphere", JCGT 2013). `across`: place of its middle on that axis. The
// ball lies before the eye.
vec2 ends_of_ball(float across, float away, float radius) {
    float tangent = sqrt(across * across + away * away - radius * radius);
    vec2 shift = vec2(-radius, radius);
    return (across * tangent + shift * away) / (away * tangent - shift * across);
}

void main() {
    probe = number;
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    place = 2.0 * corner - 1.0;
    if (probe >= 0) {
        vec3 middle = middle_of_ball(probe);
        float away = dot(middle, forward);
        float wide = length(right);
        float tall = length(up);
        vec2 across = vec2(dot(middle, right) / wide, dot(middle, up) / tall);
        bool is_drawn = away > NEAREST * radius && place_of_probe(probe).a > 0.0;
        vec2 x = is_drawn ? ends_of_ball(across.x, away, radius) / wide : vec2(0.0);
        vec2 y = is_drawn ? ends_of_ball(across.y, away, radius) / tall : vec2(0.0);
        place = vec2(mix(x.x, x.y, corner.x), mix(y.x, y.y, corner.y));
    }
    gl_Position = vec4(place.x, -place.y, 0.0, 1.0);
}
