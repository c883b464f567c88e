// The structs that host and kernels share. The host reads these very files (glrt/gpu/structs.py), so a
// field is declared once, here. Rows of four words: std140 and std430 then agree.

#include "structs/shapes.glsl"
#include "structs/material.glsl"
#include "structs/details.glsl"
#include "structs/maps.glsl"
#include "structs/lights.glsl"
#include "structs/frame.glsl"
