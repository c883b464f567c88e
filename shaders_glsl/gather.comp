// Collects the pixels of a mask that need more samples into a list, in any order.

layout(local_size_x = 8, local_size_y = 8) in;

#include "temporal/ataa.glsl"

uniform sampler2D mask;
layout(std430) buffer List { uint listed; uint pixels[]; };  // their number; each pixel as x + width y

void main() {
    ivec2 size = textureSize(mask, 0);
    int tiles = (size.x + 7) / 8;
    ivec2 texel = 8 * ivec2(int(gl_WorkGroupID.x) % tiles, int(gl_WorkGroupID.x) / tiles) + ivec2(gl_LocalInvocationID.xy);
    if (any(greaterThanEqual(texel, size))) return;
    if (int(texelFetch(mask, texel, 0).a) < TRACED) return;
    uint place = atomicAdd(listed, 1u);
    pixels[place] = uint(texel.x + size.x * texel.y);
}
