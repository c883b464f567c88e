// A number of each pixel as a colour: the uncertainty of its light, how many of its samples were
// dropped, the difference from another film's light, or a number of its history. Film row 0 is on top.

#include "film/most_layers.glsl"
#include "passes/color_scale.glsl"

const int SHOWS_ERROR = 0;
const int SHOWS_DROPPED = 1;
const int SHOWS_DIFFERENCE = 2;
const int SHOWS_HISTORY = 3;
const int SHOWS_PROBES = 4;
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);  // of linear sRGB, Rec. 709
const vec3 UNKNOWN = vec3(0.5);
const float DIM = 0.25;  // brightness of the picture below marks, and around balls

uniform sampler2D light;      // radiance, weighed as it is shown
uniform sampler2D mean;       // of the film, as in trace.comp
uniform float samples;        // number of samples of each pixel, finite or not
uniform sampler2D variance;
uniform sampler2D layers;     // as in weighting.frag
uniform sampler2D other;      // radiance to compare with; a: a number of its history
uniform int shows;
uniform int layer_count;      // 0: the light is the mean times weights[0]
uniform vec3 weights[MOST_LAYERS];
uniform float dark;           // radiance^2, added so that dark pixels do not dominate
uniform float unsure;         // number of squared standard errors that may be chance alone
uniform float luck;           // most radiance that one sample may show, over the true radiance
uniform float least;          // numbers of the history count only above it
uniform bool is_logarithmic;
uniform vec2 range;           // the numbers of the first and the last colour
uniform vec3 colors[COLORS];  // sRGB

in vec2 place;
out vec4 color;

// Squared standard error, by the formula of glrt.rendering.film.standard_error; negative below two observations.
vec3 variance_of_mean(ivec2 texel) {
    vec4 observed = texelFetch(variance, texel, 0);
    if (observed.a < 2.0) return vec3(-1.0);
    return observed.rgb / (observed.a - 1.0);
}

// The same from two halves of the observations, by the formula of glrt.rendering.weighting.mixed.
vec3 variance_by_halves(ivec2 texel) {
    ivec2 size = textureSize(mean, 0);
    vec3 apart = vec3(0.0);
    vec2 counts = vec2(0.0);
    for (int i = 0; i < layer_count; i += 1) {
        vec4 one = texelFetch(layers, size * ivec2(i, 0) + texel, 0);
        vec4 two = texelFetch(layers, size * ivec2(i, 1) + texel, 0);
        apart += weights[i] * (one.rgb - two.rgb);
        counts = vec2(one.a, two.a);
    }
    if (counts.x * counts.y == 0.0) return vec3(-1.0);
    float total = counts.x + counts.y;
    return apart * apart * (counts.x * counts.y / (total * total));
}

// The brightest of the pixels next to one in the film, by channel. A film of one pixel gives that pixel.
vec3 brightest_beside(ivec2 texel) {
    ivec2 last = textureSize(mean, 0) - 1;
    vec3 most = last == ivec2(0) ? texelFetch(light, texel, 0).rgb : vec3(0.0);
    for (int y = max(texel.y - 1, 0); y <= min(texel.y + 1, last.y); y += 1) {
        for (int x = max(texel.x - 1, 0); x <= min(texel.x + 1, last.x); x += 1) {
            if (ivec2(x, y) != texel) most = max(most, texelFetch(light, ivec2(x, y), 0).rgb);
        }
    }
    return most;
}

// The estimated true radiance of a pixel, squared, by the formula of glrt.error.estimate.squared_levels.
vec3 squared_level(ivec2 texel, vec3 radiance, vec3 squared) {
    vec3 near = min(radiance, brightest_beside(texel));
    vec3 own = radiance * radiance;
    return max(max(near * near, own - unsure * squared), own / (luck * luck));
}

// A pixel's share in the relative error of the picture (glrt.error.estimate.estimated_error).
float relative_error(ivec2 texel) {
    vec3 radiance = texelFetch(light, texel, 0).rgb;
    vec3 squared = layer_count > 0 ? variance_by_halves(texel)
                                   : weights[0] * weights[0] * variance_of_mean(texel);
    if (squared.r < 0.0) return -1.0;
    vec3 level = squared_level(texel, radiance, squared);
    return sqrt(dot(squared / (level + dark), vec3(1.0 / 3.0)));
}

// The most samples that are not finite, among the pixel and its neighbours. So no mark is lost where many
// pixels share one pixel of the screen.
float most_dropped(ivec2 texel) {
    ivec2 last = textureSize(mean, 0) - 1;
    int reach = 1 + last.y / 400;
    float most = 0.0;
    for (int y = -reach; y <= reach; y += 1) {
        for (int x = -reach; x <= reach; x += 1) {
            float count = texelFetch(mean, clamp(texel + ivec2(x, y), ivec2(0), last), 0).a;
            most = max(most, samples - count);
        }
    }
    return most;
}

// Difference of luminances, relative to the other's: negative where this film is darker.
float relative_difference(ivec2 texel) {
    float here = dot(texelFetch(light, texel, 0).rgb, LUMINANCE);
    float there = dot(texelFetch(other, texel, 0).rgb, LUMINANCE);
    return (here - there) / sqrt(there * there + dark);
}

vec3 color_of(float number) {
    if (!is_logarithmic) return color_at(colors, (number - range.x) / (range.y - range.x));
    return color_at(colors, log(max(number, range.x) / range.x) / log(range.y / range.x));
}

vec3 dimmed(ivec2 texel) {
    float luminance = max(dot(texelFetch(light, texel, 0).rgb, LUMINANCE), 0.0);
    return vec3(DIM * pow(min(luminance, 1.0), 1.0 / 2.2));
}

void main() {
    ivec2 size = textureSize(mean, 0);
    ivec2 texel = min(ivec2(place * vec2(size)), size - 1);
    vec3 shown = UNKNOWN;
    if (shows == SHOWS_ERROR) {
        float error = relative_error(texel);
        if (error >= 0.0) shown = color_of(error);
    } else if (shows == SHOWS_DROPPED) {
        float count = most_dropped(texel);
        shown = count > 0.0 ? color_of(count) : dimmed(texel);
    } else if (shows == SHOWS_HISTORY || shows == SHOWS_PROBES) {
        float number = texelFetch(other, texel, 0).a;
        if (shows == SHOWS_PROBES) shown = dimmed(texel);
        if (number > least) shown = color_of(number);
    } else {
        shown = color_of(relative_difference(texel));
    }
    color = vec4(shown, 1.0);
}
