// One update of the probes: means over the rays, for each texel of the maps.

const float LEAST_COSINE = 1e-3;     // rays nearly along a surface carry little information and much noise
const float LONGEST_DISTANCE = 1.5;  // of a cell's diagonal: longer distances are cut

// Weight of a distance: cos^50, so that a texel takes distances only from its own direction.
float sharpened(float cosine) {
    float x2 = cosine * cosine;
    float x4 = x2 * x2;
    float x8 = x4 * x4;
    float x16 = x8 * x8;
    float weight = x16 * x16 * x16 * x2;
    return weight;
}

// A weighted sum over rays.
struct Blend {
    vec3 sum;
    float weight;
};

void add_ray(inout Blend blend, vec3 value, float weight) {
    if (weight < LEAST_COSINE) return;
    blend.sum += weight * value;
    blend.weight += weight;
}

// Mixes the mean of the rays with the value from before; without new rays that value stays.
vec3 blended(Blend blend, vec3 before, float kept) {
    if (blend.weight == 0.0) return before;
    vec3 mean = blend.sum / blend.weight;
    vec3 next = mean + kept * (before - mean);
    return next;
}
