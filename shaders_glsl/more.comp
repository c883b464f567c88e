// Traces samples of the pixels of a list (gather.comp), for pixels without samples: not for a film.

layout(local_size_x = 64) in;

#include "integrators/no_record.glsl"
#include "trace.glsl"

layout(rgba32f) uniform writeonly image2D target_more;  // a: finite samples
layout(std430) buffer List { uint listed; uint pixels[]; };
layout(std430) buffer Lost { uint lost_samples; };  // as in trace.comp

void main() {
    uint place = uint(64 * frame.first_tile) + gl_GlobalInvocationID.x;
    if (place >= listed || frame.sample_count == 0) return;
    int width = imageSize(target_more).x;
    ivec2 texel = ivec2(int(pixels[place]) % width, int(pixels[place]) / width);
    Pixel pixel = empty_pixel();
    int lost = add_samples(pixel, frame.origin + texel);
    if (MAY_LOSE && lost > 0) atomicAdd(lost_samples, uint(lost));
    imageStore(target_more, texel, vec4(pixel.mean, pixel.count));
}
