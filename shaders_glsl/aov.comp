// Adds samples to one or two AOVs in tiles of a crop of the frame, as trace.comp does for radiance.

layout(local_size_x = 8, local_size_y = 8) in;

#include "aov.glsl"
#include "passes/tiles.glsl"

layout(rgba32f) uniform readonly image2D source_mean;             // a: number of its samples
layout(rgba32f) uniform readonly image2D source_variance;         // a: number of observations
layout(rgba32f) uniform readonly image2D source_second_mean;      // where IN_PIECES: the observation that has begun
layout(rgba32f) uniform readonly image2D source_second_variance;
layout(rgba32f) uniform writeonly image2D target_mean;
layout(rgba32f) uniform writeonly image2D target_variance;
layout(rgba32f) uniform writeonly image2D target_second_mean;
layout(rgba32f) uniform writeonly image2D target_second_variance;

layout(std430) buffer Lost { uint lost_samples; };  // as in trace.comp

void main() {
    ivec2 picture = imageSize(target_mean);
    ivec2 corner = tile_corner(picture, frame.first_tile + int(gl_WorkGroupID.x));
    ivec2 texel = corner + ivec2(gl_LocalInvocationID.xy);
    if (any(greaterThanEqual(texel, picture))) return;
    Pixel first = empty_pixel();
    Pixel second = empty_pixel();
    if (frame.is_empty == 0) {
        first = pixel_of(imageLoad(source_mean, texel), imageLoad(source_variance, texel));
        if (IN_PIECES) {
            vec4 begun = imageLoad(source_second_mean, texel);
            first.block = begun.rgb;
            first.begun = begun.a;
        }
        if (SECOND_AOV != NO_AOV) {
            second = pixel_of(imageLoad(source_second_mean, texel), imageLoad(source_second_variance, texel));
        }
    }
    add_aovs(first, second, frame.origin + texel);
    if (MAY_LOSE && loop_was_cut) atomicAdd(lost_samples, 1u);
    imageStore(target_mean, texel, vec4(first.mean, first.count));
    imageStore(target_variance, texel, vec4(first.variance, first.observations));
    if (IN_PIECES) imageStore(target_second_mean, texel, vec4(first.block, first.begun));
    if (SECOND_AOV == NO_AOV) return;
    imageStore(target_second_mean, texel, vec4(second.mean, second.count));
    imageStore(target_second_variance, texel, vec4(second.variance, second.observations));
}
