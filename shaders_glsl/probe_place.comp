// Moves probes out of solids and away from surfaces, by the hits of their rays: one lane per probe.

layout(local_size_x = 64) in;

#include "structs/scene.glsl"
#include "scene_arrays.glsl"
#include "sampling/warp.glsl"
#include "shapes/ray.glsl"
#include "shapes/hit.glsl"
#include "structs/probes.glsl"
#include "probes/grid.glsl"
#include "probes/place.glsl"

layout(std140) uniform ProbeBlock {
    ProbeUpdate update;
    vec4 directions[MOST_PROBE_RAYS];
};
uniform sampler2D probe_rays;
layout(rgba32f) uniform image2D updated_map;

void main() {
    int probe = 64 * (frame.first_tile + int(gl_WorkGroupID.x)) + int(gl_LocalInvocationIndex);
    if (probe >= frame.probe_count) return;
    Surroundings around = nothing_around();
    for (int i = 0; i < update.rays; i += 1) {
        look(around, directions[i].xyz, texelFetch(probe_rays, ivec2(i, probe), 0).a);
    }
    ivec2 at = ivec2(probe % PROBES_IN_ROW, probe / PROBES_IN_ROW);
    vec3 offset = imageLoad(updated_map, at).xyz;
    vec3 next = update.purpose == FOR_PUSHES ? pushed(around, offset) : offset;
    imageStore(updated_map, at, vec4(next, is_in_solid(around) ? 0.0 : 1.0));
}
