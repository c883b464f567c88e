// Probes as balls: shared by both stages of that pass. Places are relative to the eye. Files that include it declare
// before: the frame, with the grid; the maps of probes.

vec4 probe_light_at(ivec2 texel) { return texelFetch(probe_light, texel, 0); }
vec4 probe_distances_at(ivec2 texel) { return texelFetch(probe_distances, texel, 0); }
vec4 probe_place_at(ivec2 texel) { return texelFetch(probe_places, texel, 0); }

#include "sampling/warp.glsl"
#include "probes/octahedron.glsl"
#include "probes/grid.glsl"
#include "probes/maps.glsl"

vec3 middle_of_ball(int probe) {
    vec3 middle = middle_of_cell(probe) + place_of_probe(probe).xyz;
    return middle;
}
