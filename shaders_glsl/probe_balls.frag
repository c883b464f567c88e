// A picture with its probes as balls. Each ball shows the data of its probe by direction. Radiance: the irradiance
// there as it would light a white matte surface. a: the mean distance, below 0 around the balls. Row 0 is that of the
// film: on top.

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

uniform sampler2D light;  // radiance of the picture
uniform sampler2D depth;  // of the surface that each pixel shows, along the view axis; a: 0 for none

flat in int probe;
in vec2 place;
out vec4 found;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    if (probe < 0) {
        found = vec4(texelFetch(light, texel, 0).rgb, -1.0);
        return;
    }
    vec3 direction = forward + place.x * right + place.y * up;
    vec3 middle = middle_of_ball(probe);
    float a = dot(direction, direction);
    float b = dot(direction, middle);
    float root = b * b - a * (dot(middle, middle) - radius * radius);
    if (root < 0.0) discard;
    float away = (b - sqrt(root)) / a;  // along the view axis: forward has length 1
    vec4 behind = texelFetch(depth, texel, 0);
    if (behind.a > 0.0 && away > behind.r) discard;
    vec3 normal = normalized(away * direction - middle);
    vec3 radiance = light_at_probe(probe, normal) / PI;
    found = vec4(radiance, distances_at_probe(probe, normal).x);
}
