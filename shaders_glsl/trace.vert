// Tiles of a crop of the frame, each an instance of four vertices, for trace.frag.

#include "structs/scene.glsl"
#include "scene_arrays.glsl"
#include "passes/tiles.glsl"

uniform sampler2D source_mean;  // of the size of the picture

void main() {
    ivec2 picture = textureSize(source_mean, 0);
    ivec2 corner = tile_corner(picture, frame.first_tile + gl_InstanceID);
    ivec2 place = corner + TILE * ivec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(2.0 * vec2(place) / vec2(picture) - 1.0, 0.0, 1.0);
}
