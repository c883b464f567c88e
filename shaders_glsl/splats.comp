// Adds one observation to the film of particles: the sums that they added to each pixel, which start again at 0.

layout(local_size_x = 8, local_size_y = 8) in;

#include "structs/scene.glsl"
#include "scene_arrays.glsl"
#include "sampling/unit_float.glsl"
#include "film/finite.glsl"
#include "film/pixel.glsl"
#include "film/splat_unit.glsl"
#include "passes/tiles.glsl"

layout(rgba32f) uniform readonly image2D source_mean;      // a: observations
layout(rgba32f) uniform readonly image2D source_variance;  // a: observations
layout(rgba32f) uniform writeonly image2D target_mean;
layout(rgba32f) uniform writeonly image2D target_variance;

layout(std430) buffer Splats {  // as in particles.comp
    uint clipped;
    uint refused;
    uint words[];
};

const float HIGH = 4294967296.0;  // 2^32

// Takes the sum of a word and the one above it, and sets both to 0.
float take_sum(int at) {
    float sum = float(words[at + 1]) * HIGH + float(words[at]);
    words[at] = 0u;
    words[at + 1] = 0u;
    return sum;
}

// Adds radiance to a film at a texel.
void add_observation(ivec2 texel, vec3 radiance) {
    Pixel pixel = empty_pixel();
    if (frame.is_empty == 0) pixel = pixel_of(imageLoad(source_mean, texel), imageLoad(source_variance, texel));
    add_sample(pixel, radiance, 0);
    imageStore(target_mean, texel, vec4(pixel.mean, pixel.count));
    imageStore(target_variance, texel, vec4(pixel.variance, pixel.observations));
}

// Adds the light of all particles, and its layers next to it, if there are any.
void main() {
    ivec2 picture = ivec2(imageSize(target_mean).x / (LAYERS + 1), imageSize(target_mean).y);
    ivec2 corner = tile_corner(picture, frame.first_tile + int(gl_WorkGroupID.x));
    ivec2 texel = corner + ivec2(gl_LocalInvocationID.xy);
    if (any(greaterThanEqual(texel, picture))) return;
    float unit = splat_unit() / (frame.particles * float(frame.sample_count));
    vec3 sum = vec3(0.0);
    for (int layer = 0; layer < max(LAYERS, 1); layer += 1) {
        int at = 6 * ((layer * picture.y + texel.y) * picture.x + texel.x);
        float red = take_sum(at);
        float green = take_sum(at + 2);
        float blue = take_sum(at + 4);
        vec3 units = vec3(red, green, blue);
        sum += units;
        if (LAYERS > 0) add_observation(texel + ivec2((layer + 1) * picture.x, 0), units * unit);
    }
    add_observation(texel, sum * unit);
}
