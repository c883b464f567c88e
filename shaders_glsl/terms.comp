// Adds samples to terms of light, as trace.comp does for radiance. The terms that are kept lie side by side. A dispatch
// adds whole observations, so that none is carried from one to the next, except IN_PIECES.

layout(local_size_x = 8, local_size_y = 8) in;

#include "integrators/no_record.glsl"
#include "trace.glsl"
#include "passes/tiles.glsl"

layout(rgba32f) uniform readonly image2D source_mean;      // a: number of its samples
layout(rgba32f) uniform readonly image2D source_variance;  // a: number of observations
layout(rgba32f) uniform readonly image2D source_block;     // a: its samples, where IN_PIECES
layout(rgba32f) uniform writeonly image2D target_mean;
layout(rgba32f) uniform writeonly image2D target_variance;
layout(rgba32f) uniform writeonly image2D target_block;

layout(std430) buffer Lost { uint lost_samples; };  // as in trace.comp

ivec2 picture_size() {
    ivec2 size = imageSize(target_mean);
    return ivec2(size.x / bitCount(LIGHT_TERMS), size.y);
}

// The place of a term; bits of LIGHT_TERMS below its own stand for the terms on its left.
ivec2 place_of(ivec2 texel, int term) {
    return texel + ivec2(picture_size().x * bitCount(LIGHT_TERMS & (1 << term) - 1), 0);
}

void load_terms(ivec2 texel) {
    for (int i = 0; i < TERMS; i += 1) {
        term_pixels[i] = empty_pixel();
        if (!is_kept(i) || frame.is_empty != 0) continue;
        ivec2 place = place_of(texel, i);
        term_pixels[i] = pixel_of(imageLoad(source_mean, place), imageLoad(source_variance, place));
        if (IN_PIECES) {
            vec4 begun = imageLoad(source_block, place);
            term_pixels[i].block = begun.rgb;
            term_pixels[i].begun = begun.a;
        }
    }
}

void store_terms(ivec2 texel) {
    for (int i = 0; i < TERMS; i += 1) {
        if (!is_kept(i)) continue;
        Pixel pixel = term_pixels[i];
        imageStore(target_mean, place_of(texel, i), vec4(pixel.mean, pixel.count));
        imageStore(target_variance, place_of(texel, i), vec4(pixel.variance, pixel.observations));
        if (IN_PIECES) imageStore(target_block, place_of(texel, i), vec4(pixel.block, pixel.begun));
    }
}

void main() {
    ivec2 picture = picture_size();
    ivec2 corner = tile_corner(picture, frame.first_tile + int(gl_WorkGroupID.x));
    ivec2 texel = corner + ivec2(gl_LocalInvocationID.xy);
    if (any(greaterThanEqual(texel, picture))) return;
    load_terms(texel);
    Pixel whole = empty_pixel();
    int lost = add_samples(whole, frame.origin + texel);
    if (MAY_LOSE && lost > 0) atomicAdd(lost_samples, uint(lost));
    store_terms(texel);
}
