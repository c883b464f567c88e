// Shared by raster.vert and raster.frag: what may be a first surface is drawn, and each fragment solves the same
// intersection with the ray of its pixel as the tracer does.

#include "structs/scene.glsl"
#include "scene_arrays.glsl"
#include "sampling/hash.glsl"
#include "sampling/unit_float.glsl"
#include "sampling/sobol.glsl"
#include "sampling/net.glsl"
#include "sampling/sampler.glsl"
#include "sampling/warp.glsl"
#include "sampling/angle.glsl"
#include "sampling/hole_numbers.glsl"
#include "shapes/all_shapes.glsl"

// Parts of a raster: a draw call for each, with six vertices for every thing that it draws.
const int BACKDROP = 0;  // the whole frame, where nothing is met
const int PROXIES = 1;   // rectangles around all shapes but triangles
const int FACES = 2;     // triangles
