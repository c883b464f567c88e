// The first surface behind the middle of each pixel of tiles of a crop of the frame.

layout(local_size_x = 8, local_size_y = 8) in;

#include "surfaces.glsl"
#include "passes/tiles.glsl"

layout(rgba32f) uniform writeonly image2D target_position;
layout(rgba32f) uniform writeonly image2D target_normal;

void main() {
    ivec2 picture = imageSize(target_position);
    ivec2 corner = tile_corner(picture, frame.first_tile + int(gl_WorkGroupID.x));
    ivec2 texel = corner + ivec2(gl_LocalInvocationID.xy);
    if (any(greaterThanEqual(texel, picture))) return;
    MiddleSurface found = middle_surface(frame.origin + texel);
    imageStore(target_position, texel, found.position);
    imageStore(target_normal, texel, found.normal);
}
