// What one update of the probes makes of its rays: means over them, for each texel of the maps.

const float LEAST_COSINE = 1e-3;     // rays beside a normal say little, and at random
const float LONGEST_DISTANCE = 1.5;  // of a cell's diagonal: what is farther is far

// Of distances: cos^50, so that a texel hears of its own direction alone.
float sharpened(float cosine) {
    precise float x2 = cosine * cosine;
    precise float x4 = x2 * x2;
    precise float x8 = x4 * x4;
    precise float x16 = x8 * x8;
    precise float weight = x16 * x16 * x16 * x2;
    return weight;
}

// A sum over rays by weight.
struct Blend {
    vec3 sum;
    float weight;
};

void add_ray(precise inout Blend blend, vec3 value, float weight) {
    if (weight < LEAST_COSINE) return;
    blend.sum += weight * value;
    blend.weight += weight;
}

// With what was held before; nothing new leaves it as it is.
vec3 blended(Blend blend, vec3 before, float kept) {
    if (blend.weight == 0.0) return before;
    precise vec3 mean = blend.sum / blend.weight;
    precise vec3 next = mean + kept * (before - mean);
    return next;
}
