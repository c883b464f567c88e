// The picture of predictions: the mean over pixels around whose features are similar (a bilateral filter). It helps
// since the errors of neighbours are independent. As the film grows, it replaces the predictions.

#include "film/finite.glsl"
#include "temporal/least_squares.glsl"
#include "temporal/wrls.glsl"

uniform sampler2D prediction;  // from predict.frag
uniform sampler2D feature;     // first row of the models of predict.frag
uniform sampler2D light;       // the film under its weights
uniform float samples;         // of the film
uniform float end;             // samples of the film from which on only the film is shown

out vec4 shown;                // radiance, and number of views that the model has seen

const int REACH = 2;             // pixels
const float PIXELS = 1.5;        // standard deviation of weights by distance
const float LIKENESS = 0.3;      // standard deviation of weights by relative distance of features

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(light, 0) - 1;
    vec4 own = texelFetch(feature, texel, 0);
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int n = 0; n < (2 * REACH + 1) * (2 * REACH + 1); n += 1) {
        ivec2 off = ivec2(n % (2 * REACH + 1), n / (2 * REACH + 1)) - REACH;
        ivec2 near = texel + off;
        if (near != clamp(near, ivec2(0), last)) continue;
        float away = dot(vec2(off), vec2(off)) / (PIXELS * PIXELS);
        float unlike = relative_distance(texelFetch(feature, near, 0).rgb, own.rgb) / LIKENESS;
        float weight = exp(-0.5 * (away + unlike * unlike));
        sum += weight * texelFetch(prediction, near, 0).rgb;
        total += weight;
    }
    vec3 smooth_radiance = max(sum / total, 0.0);
    vec3 fresh = texelFetch(light, texel, 0).rgb;
    float left = max(1.0 - samples / max(end, samples), 0.0);
    shown = vec4(fresh + left * (smooth_radiance - fresh), own.a);
    if (!is_finite(shown.rgb)) shown.rgb = fresh;
}
