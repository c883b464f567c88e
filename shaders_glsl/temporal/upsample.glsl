// Temporal upsampling: one pixel in k x k is sampled in each frame, another one in the next, and the full picture is
// reconstructed from these samples and from history. The frame is that of FSR 2 (AMD, 2022): samples at places that
// differ from frame to frame, reprojected history of full size, history of other light kept near the samples around.
// The weights are glrt's own, since samples of paths are noisy.
//
// Each sampled pixel has a pair of samples with independent noise. Half the mean square of their differences is the
// variance of a sample. The variance between the means of pixels around also contains what differs from pixel to pixel.

const float SPREAD = 0.5;         // standard deviation of the filter between sampled pixels, in their distances
const float MOST_GUESSED = 64.0;  // samples that a mean over pixels around may stand for
const float PAIR = 2.0;           // samples of a sampled pixel
const float MARGIN = 2.0;
const float STRANGER = 0.25;      // samples that light of another surface stands for, where there is nothing else
const float REACH = 1.0;          // history of other light is kept within so many deviations of the samples around

float filter_weight(vec2 off, float k) {
    vec2 steps = off / (SPREAD * k);
    float weight = exp(-0.5 * dot(steps, steps));
    return weight;
}

// The variance of detail: the part of the variance of the means of pairs beyond MARGIN times what noise explains, since
// variances of a few pixels differ by chance. `noise`: variance of a sample.
float detail_of(float variance, float noise) {
    float detail = max(variance - MARGIN * noise / PAIR, 0.0);
    return detail;
}

// The samples that a mean over pixels around counts for, next to the pixel's own samples: each weighs by 1 over its
// mean squared error, noise / N for N own samples, and detail + noise / guessed for the mean around. So nothing is
// averaged where there is no noise.
float prior_samples(float noise, float detail, float guessed) {
    if (noise <= 0.0 || guessed <= 0.0) return 0.0;
    float samples = noise / (detail + noise / guessed);
    return samples;
}
