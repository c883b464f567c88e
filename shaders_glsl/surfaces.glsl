// Shared by surfaces.comp and surfaces.frag: the first surface behind the middle of each pixel. By these surfaces,
// samples are found again when the camera has moved.

#include "structs/scene.glsl"
#include "scene_arrays.glsl"
#include "sampling/hash.glsl"
#include "sampling/unit_float.glsl"
#include "sampling/sobol.glsl"
#include "sampling/sobol64.glsl"
#include "sampling/net.glsl"
#include "sampling/sampler.glsl"
#include "sampling/warp.glsl"
#include "sampling/angle.glsl"
#include "sampling/hole_numbers.glsl"
#include "shapes/all_shapes.glsl"
#include "integrators/middle_ray.glsl"
#include "passes/surface_flags.glsl"
#include "integrators/middle_surface.glsl"
