// What aov.comp and aov.frag share: the outputs that tell what the first surface behind a pixel is
// (AOVs, arbitrary output variables). The camera rays are those of the paths of trace.glsl.

#include "structs/scene.glsl"
#include "scene_arrays.glsl"
#include "sampling/hash.glsl"
#include "sampling/unit_float.glsl"
#include "sampling/sobol.glsl"
#include "sampling/sampler.glsl"
#include "sampling/warp.glsl"
#include "sampling/angle.glsl"
#include "sampling/hole_numbers.glsl"
#include "shapes/all_shapes.glsl"
#include "integrators/camera.glsl"
#include "integrators/middle_ray.glsl"
#include "film/pixel.glsl"
#include "integrators/aov_numbers.glsl"
#include "bsdfs/conductor.glsl"
#include "integrators/first_hit.glsl"
