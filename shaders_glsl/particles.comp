// Follows particles from the lamps, and adds their light to the pixels of a crop of the frame in fixed point. A sum
// of integers does not depend on the order of its terms, so that pictures have the same bits every time.

layout(local_size_x = 64) in;

#include "integrators/no_record.glsl"
#include "trace.glsl"
#include "film/splat_unit.glsl"

layout(std430) buffer Splats {
    uint clipped;  // how many values were larger than MOST; each counts as MOST
    uint refused;  // how many values were not finite; these are left out
    uint words[];  // of each pixel of each layer: low and high words of red, green and blue, in units of radiance
};
layout(std430) buffer Lost { uint lost_samples; };

layout(rgba32f) uniform readonly image2D source_mean;  // the crop, with its layers next to it

const float MOST = 7.2057594037927936e16;  // 2^56 units
const float HIGH = 4294967296.0;           // 2^32

// Counts of this lane, added up at the end. Where rays find triangles, llvmpipe lets all lanes of a SIMD group take
// part in an atomic operation on one word that only some of them reach.
uint own_clipped = 0u;
uint own_refused = 0u;

void add_words(int at, float units) {
    float high = floor(units / HIGH);
    uint low = uint(units - high * HIGH);
    uint before = atomicAdd(words[at], low);
    uint more = uint(high) + (before > 0xFFFFFFFFu - low ? 1u : 0u);
    if (more > 0u) atomicAdd(words[at + 1], more);
}

ivec2 crop_size() {
    ivec2 size = imageSize(source_mean);
    return ivec2(size.x / (LAYERS + 1), size.y);
}

// Adds radiance to a pixel of the crop.
void add_to_pixel(ivec2 pixel, vec3 radiance, int layer) {
    vec3 units = radiance / splat_unit();
    if (!is_finite(units)) {
        own_refused += 1u;
        return;
    }
    if (any(greaterThan(units, vec3(MOST)))) own_clipped += 1u;
    ivec2 size = crop_size();
    int at = 6 * ((layer * size.y + pixel.y) * size.x + pixel.x);
    for (int i = 0; i < 3; i += 1) add_words(at + 2 * i, min(floor(units[i] + 0.5), MOST));
}

// Adds radiance to the pixel at a place of the frame, in pixels.
void splat(vec2 place, vec3 radiance, int layer) {
    ivec2 pixel = ivec2(floor(place)) - frame.origin;
    bool is_outside = any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, crop_size()));
    if (!is_outside && !COUNT_RAYS) add_to_pixel(pixel, radiance, layer);
}

#include "integrators/particle_start.glsl"
#include "integrators/camera_links.glsl"
#include "integrators/light_links.glsl"
#include "integrators/particles.glsl"

void main() {
    int group = frame.first_tile + int(gl_WorkGroupID.x);
    int lost = add_particles(64 * group + int(gl_LocalInvocationIndex), group < frame.linked_groups);
    if (own_clipped > 0u) atomicAdd(clipped, own_clipped);
    if (own_refused > 0u) atomicAdd(refused, own_refused);
    if (COUNT_RAYS) add_to_pixel(ivec2(0), vec3(rays_so_far * frame.particles), 0);  // a mean over the frame
    if (MAY_LOSE && lost > 0) atomicAdd(lost_samples, uint(lost));
}
