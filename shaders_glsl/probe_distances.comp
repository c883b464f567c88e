// Blends the distances found by the rays of one update into the maps of the probes: one lane per texel.

layout(local_size_x = 64) in;

#include "structs/scene.glsl"
#include "scene_arrays.glsl"
#include "sampling/warp.glsl"
#include "probes/octahedron.glsl"
#include "probes/grid.glsl"
#include "structs/probes.glsl"
#include "probes/blend.glsl"
#include "probes/turns.glsl"

layout(std140) uniform ProbeBlock {
    ProbeUpdate update;
    vec4 directions[MOST_PROBE_RAYS];
};
uniform sampler2D probe_rays;
layout(rgba32f) uniform image2D updated_map;

const int TEXELS = (DISTANCE_SIDE + 2) * (DISTANCE_SIDE + 2);  // of a map

void blend_distances(int probe, ivec2 texel) {
    vec3 direction = direction_of_texel(inner_texel(texel, DISTANCE_SIDE), DISTANCE_SIDE);
    float longest = LONGEST_DISTANCE * length(frame.probe_cell);
    Blend blend = Blend(vec3(0.0), 0.0);
    for (int i = 0; i < update.rays; i += 1) {
        float distance = min(abs(texelFetch(probe_rays, ivec2(i, probe), 0).a), longest);
        float cosine = max(dot(directions[i].xyz, direction), 0.0);
        if (distance > 0.0) add_ray(blend, vec3(distance, distance * distance, 0.0), sharpened(cosine));
    }
    ivec2 at = corner_of_map(probe, DISTANCE_SIDE) + texel;
    vec3 before = imageLoad(updated_map, at).rgb;
    imageStore(updated_map, at, vec4(blended(blend, before, update.kept), 1.0));
}

void main() {
    int index = 64 * (frame.first_tile + int(gl_WorkGroupID.x)) + int(gl_LocalInvocationIndex);
    int probe = probe_in_turn(update, index / TEXELS);
    int texel = index % TEXELS;
    if (probe < frame.probe_count) blend_distances(probe, ivec2(texel % (DISTANCE_SIDE + 2), texel / (DISTANCE_SIDE + 2)));
}
