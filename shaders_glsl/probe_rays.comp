// Sends rays from probes: one lane per ray. Each finds the light that comes along it, and the distance to its hit.

layout(local_size_x = 64) in;

#include "probes/first_met.glsl"
#include "trace.glsl"
#include "structs/probes.glsl"
#include "probes/solids.glsl"
#include "probes/turns.glsl"

layout(std140) uniform ProbeBlock {
    ProbeUpdate update;
    vec4 directions[MOST_PROBE_RAYS];  // unit
};
layout(std430) buffer Lost { uint lost_samples; };
layout(rgba32f) uniform writeonly image2D target_rays;  // a row per probe; a: distance (below 0: wrong face, 0: lost)

// Radiance along a ray from a probe, and the distance to its hit.
vec4 light_along(Ray ray, inout Sampler rng) {
    Path path = start_path(ray);
    if (update.purpose != FOR_LIGHT) path.depth = frame.bounces;  // the path ends at its first hit
    bool goes = extend_path(path, rng);
    if (has_met && is_wrong_face(met_object, met_normal, ray.direction)) {
        vec4 wrong = vec4(vec3(0.0), WRONG_FACE * met_distance);
        return wrong;
    }
    while (goes && update.purpose == FOR_LIGHT) goes = extend_path(path, rng);
    if (loop_was_cut || !is_finite(path.radiance)) return vec4(0.0);
    return vec4(path.radiance, has_met ? met_distance : FAR);
}

void main() {
    int index = 64 * (frame.first_tile + int(gl_WorkGroupID.x)) + int(gl_LocalInvocationIndex);
    int probe = probe_in_turn(update, index / update.rays);
    int number = index % update.rays;
    if (probe >= frame.probe_count) return;
    vec3 stand = middle_of_cell(probe) + place_of_probe(probe).xyz;
    Sampler rng = sampler_at(ivec2(number, probe), update.number, update.seed);
    vec4 found = light_along(Ray(stand, directions[number].xyz, NO_SHAPE, false), rng);
    if (COUNT_RAYS) found.rgb = vec3(rays_so_far);
    imageStore(target_rays, ivec2(number, probe), found);
    if (MAY_LOSE && loop_was_cut) atomicAdd(lost_samples, 1u);
}
