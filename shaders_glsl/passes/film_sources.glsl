// The last frame of a film. A kernel reads it as textures and writes the next frame as images, as OpenGL 4.3 promises
// only eight images.

uniform sampler2D source_mean;      // a: finite samples
uniform sampler2D source_variance;  // a: observations
uniform sampler2D source_block;     // the incomplete observation; a: its samples

Pixel load_pixel(ivec2 texel) {
    if (frame.is_empty != 0) return empty_pixel();  // the source may hold anything
    vec4 mean = texelFetch(source_mean, texel, 0);
    vec4 variance = texelFetch(source_variance, texel, 0);
    vec4 block = vec4(0.0);
    if (BLOCK > 1) block = texelFetch(source_block, texel, 0);
    return Pixel(mean.rgb, mean.a, variance.rgb, variance.a, block.rgb, block.a);
}
