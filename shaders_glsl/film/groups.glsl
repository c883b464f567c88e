// The means of groups of blocks, where pixels share random numbers (sampling/sampler.glsl): block number b is of group
// b % GROUPS. A dispatch adds to SLOTS successive groups at most, and reads and writes no others.

const int GROUPS = 16;
const int GROUP_COLUMNS = 4;  // groups side by side in a texture
const int SLOTS = 3;

vec4 group_means[SLOTS];  // a: finite samples

// Adds a sample to the group in a slot; a sample that is not finite is left out.
void add_to_group(inout Pixel pixel, vec3 x, int slot) {
    if (!is_finite(x)) return;
    pixel.count += 1.0;
    pixel.mean = next_mean(pixel.mean, x, pixel.count);
    vec4 held = group_means[0];
    for (int i = 1; i < SLOTS; i += 1) {
        if (i == slot) held = group_means[i];
    }
    held.a += 1.0;
    held.rgb = next_mean(held.rgb, x, held.a);
    for (int i = 0; i < SLOTS; i += 1) {
        if (i == slot) group_means[i] = held;
    }
}
