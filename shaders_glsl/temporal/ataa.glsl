// Adaptive temporal antialiasing: where an exponential mean over views fails, and the method that replaces it. Marrs et
// al., "Adaptive Temporal Antialiasing" (2018). The thresholds are glrt's own; FXAA is that of Lottes (2009).

const int KEEPS = 0;            // the mean over views is kept
const int FILTERED = 1;         // the surface was outside the view before: FXAA
const int TRACED = 2;           // more samples, blended with history
const int TRACED_ALONE = 3;     // more samples, without history

const float ENOUGH_SAMPLES = 8.0;  // samples of history from which on an edge is smooth
const float OFF_BOX = 0.1;         // of luma: history further beyond the present neighbourhood is wrong
const float CONTRAST = 0.25;       // range of luma within 3 x 3 pixels: a shadow, or the edge of a texture
const float STEADY = 0.25;         // pixels that an image in a mirror may move
const float LEAST_RANGE = 0.0625;  // of luma: FXAA leaves pixels of a smaller range alone
const float RANGE_SHARE = 0.125;   // least range relative to the greatest luma
const float LONGEST = 8.0;         // pixels that FXAA reaches along an edge
const float FLATTEST = 0.125;      // of the mean of four lumas: it keeps noise out of directions
const float LEAST_BIAS = 0.0078125;  // 1 / 128

// Luma from 0 to 1: differences count as they do to the eye.
float luma_of(vec3 rgb) {
    float luma = dot(max(rgb, 0.0), vec3(0.299, 0.587, 0.114));
    float mapped = luma / (1.0 + luma);
    return mapped;
}

vec3 mapped_of(vec3 rgb) {
    vec3 mapped = rgb / (1.0 + dot(max(rgb, 0.0), vec3(0.299, 0.587, 0.114)));
    return mapped;
}

vec3 unmapped(vec3 mapped) {
    vec3 rgb = mapped / max(1.0 - dot(mapped, vec3(0.299, 0.587, 0.114)), 1e-6);
    return rgb;
}

// The number of what a pixel shows. `place`: the place of its surface in the view before, negative where that is
// outside the view. `known`: samples of history. `off`: how far history is beyond the lumas of 3 x 3 pixels. `range`:
// the range of these lumas.
int failure_of(vec2 texel, vec2 place, float known, float off, float range, bool is_edge, bool is_specular) {
    if (place.x < 0.0) return FILTERED;
    if (known <= 0.0) return TRACED_ALONE;
    if (is_specular && length(place - texel) > STEADY) return TRACED_ALONE;
    if (!is_edge && range <= CONTRAST) return KEEPS;
    if (off > OFF_BOX) return TRACED_ALONE;
    return known < ENOUGH_SAMPLES ? TRACED : KEEPS;
}
