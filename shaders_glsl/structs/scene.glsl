// The structs that host and kernels share. The host reads these files (glrt/gpu/structs.py), so a
// field is declared once, here. Structs have rows of four words, so that std140 and std430 agree.

#include "structs/shapes.glsl"
#include "structs/material.glsl"
#include "structs/details.glsl"
#include "structs/maps.glsl"
#include "structs/lights.glsl"
#include "structs/media.glsl"
#include "structs/frame.glsl"
