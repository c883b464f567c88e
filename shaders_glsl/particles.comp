// Follows particles from the lamps, and adds what they bring to the pixels of a crop of the frame, in fixed point:
// a sum of integers does not depend on the order of its terms, so that pictures have the same bits every time.

layout(local_size_x = 64) in;

#include "integrators/no_record.glsl"
#include "trace.glsl"
#include "film/splat_unit.glsl"

layout(std430) buffer Splats {
    uint clipped;  // how many were larger than MOST, and count as that
    uint refused;  // how many were not finite, and count for nothing
    uint words[];  // of each pixel: low and high words of red, green and blue, in units of radiance
};
layout(std430) buffer Lost { uint lost_samples; };

layout(rgba32f) uniform readonly image2D source_mean;  // as large as the crop

const float MOST = 7.2057594037927936e16;  // 2^56 units
const float HIGH = 4294967296.0;           // 2^32

void add_words(int at, float units) {
    precise float high = floor(units / HIGH);
    uint low = uint(units - high * HIGH);
    uint before = atomicAdd(words[at], low);
    uint more = uint(high) + (before > 0xFFFFFFFFu - low ? 1u : 0u);
    if (more > 0u) atomicAdd(words[at + 1], more);
}

// Adds radiance to a pixel of the crop.
void add_to_pixel(ivec2 pixel, vec3 radiance) {
    precise vec3 units = radiance / splat_unit();
    if (!is_finite(units)) {
        atomicAdd(refused, 1u);
        return;
    }
    if (any(greaterThan(units, vec3(MOST)))) atomicAdd(clipped, 1u);
    int at = 6 * (pixel.y * imageSize(source_mean).x + pixel.x);
    for (int i = 0; i < 3; i += 1) add_words(at + 2 * i, min(floor(units[i] + 0.5), MOST));
}

// Adds radiance to the pixel at a place of the frame, in pixels.
void splat(vec2 place, vec3 radiance) {
    ivec2 pixel = ivec2(floor(place)) - frame.origin;
    bool is_outside = any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, imageSize(source_mean)));
    if (!is_outside && !COUNT_RAYS) add_to_pixel(pixel, radiance);
}

#include "integrators/particle_start.glsl"
#include "integrators/camera_links.glsl"
#include "integrators/particles.glsl"

void main() {
    int group = frame.first_tile + int(gl_WorkGroupID.x);
    int lost = add_particles(64 * group + int(gl_LocalInvocationIndex), group < frame.linked_groups);
    if (COUNT_RAYS) add_to_pixel(ivec2(0), vec3(rays_so_far * frame.particles));  // a mean over the frame
    if ((HAS_SPHERE_TREE || HAS_TREE || HAS_MESH) && lost > 0) atomicAdd(lost_samples, uint(lost));
}
