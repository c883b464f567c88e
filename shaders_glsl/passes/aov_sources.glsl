// The last frame of the AOVs of a pass; a: number of samples of a mean, number of observations of a variance.

uniform sampler2D source_mean;
uniform sampler2D source_variance;
uniform sampler2D source_second_mean;
uniform sampler2D source_second_variance;

Pixel load_first(ivec2 texel) {
    if (frame.is_empty != 0) return empty_pixel();
    return pixel_of(texelFetch(source_mean, texel, 0), texelFetch(source_variance, texel, 0));
}

Pixel load_second(ivec2 texel) {
    if (frame.is_empty != 0 || SECOND_AOV == NO_AOV) return empty_pixel();
    return pixel_of(texelFetch(source_second_mean, texel, 0), texelFetch(source_second_variance, texel, 0));
}
