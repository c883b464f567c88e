// Adaptive temporal antialiasing: where an exponential mean over views fails, and what takes its place. Marrs et al.,
// "Adaptive Temporal Antialiasing" (2018). The thresholds are glrt's own; FXAA is that of Lottes (2009).

const int KEEPS = 0;            // the mean over views does
const int FILTERED = 1;         // what is seen was outside the view before: FXAA
const int TRACED = 2;           // more samples, and history beside them
const int TRACED_ALONE = 3;     // more samples, and no history

const float ENOUGH_SAMPLES = 8.0;  // that history stands for, from which on an edge is smooth
const float OFF_BOX = 0.1;         // of luma: history further beyond what is seen now is wrong
const float CONTRAST = 0.25;       // of luma, within 3 x 3 pixels: a shadow, or the edge of a texture
const float STEADY = 0.25;         // pixels that a mirror may move
const float LEAST_RANGE = 0.0625;  // of luma: FXAA leaves less alone
const float RANGE_SHARE = 0.125;   // of the greatest luma, likewise
const float LONGEST = 8.0;         // pixels along an edge
const float FLATTEST = 0.125;      // of the mean of four lumas: it keeps directions from noise
const float LEAST_BIAS = 0.0078125;  // 1 / 128

// From 0 to 1: differences count as to the eye.
float luma_of(vec3 rgb) {
    precise float luma = dot(max(rgb, 0.0), vec3(0.299, 0.587, 0.114));
    precise float mapped = luma / (1.0 + luma);
    return mapped;
}

vec3 mapped_of(vec3 rgb) {
    precise vec3 mapped = rgb / (1.0 + dot(max(rgb, 0.0), vec3(0.299, 0.587, 0.114)));
    return mapped;
}

vec3 unmapped(vec3 mapped) {
    precise vec3 rgb = mapped / max(1.0 - dot(mapped, vec3(0.299, 0.587, 0.114)), 1e-6);
    return rgb;
}

// What a pixel shows. `place`: that of its surface in the view before, negative where that is outside the view. `known`: samples
// of history, `off`: how far it is beyond the lumas of 3 x 3 pixels, whose range is `range`.
int failure_of(vec2 texel, vec2 place, float known, float off, float range, bool is_edge, bool is_specular) {
    if (place.x < 0.0) return FILTERED;
    if (known <= 0.0) return TRACED_ALONE;
    if (is_specular && length(place - texel) > STEADY) return TRACED_ALONE;
    if (!is_edge && range <= CONTRAST) return KEEPS;
    if (off > OFF_BOX) return TRACED_ALONE;
    return known < ENOUGH_SAMPLES ? TRACED : KEEPS;
}
