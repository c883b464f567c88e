// Weighted recursive least squares (temporal/wrls.glsl): the prediction of each pixel's model for the film, and
// the model after it.

#include "film/finite.glsl"
#include "temporal/least_squares.glsl"
#include "temporal/wrls.glsl"
#include "temporal/wrls_rows.glsl"

uniform sampler2D light;         // the film from reconstruct.frag
uniform sampler2D known_row[7];  // of the models that were moved to this view
uniform bool has_history;
uniform float frame;             // samples of a frame: the count of the view before
uniform bool is_delayed;         // the predictor is the feature of the frame before

layout(location = 0) out vec4 prediction;  // radiance, and the weight of the film
layout(location = 1) out vec4 new_row[7];

Model model_at(ivec2 texel) {
    Rows known;
    for (int j = 0; j < 7; j += 1) known.row[j] = texelFetch(known_row[j], texel, 0);
    return model_of(known);
}

float frames_of(float count) {
    return max(count / frame, 1.0);
}

Prediction of_no_sample(Model model) {
    vec3 radiance = model.fit.slopes * vec4(1.0, model.feature);
    return Prediction(model, radiance, 0.0);
}

// The prediction with a film. The film's nearest 3 x 3 pixels give the limits in which a feature is kept.
Prediction with_film(Model model, vec3 fresh, float count, ivec2 texel) {
    ivec2 last = textureSize(light, 0) - 1;
    vec3 lowest = fresh;
    vec3 highest = fresh;
    for (int n = 0; n < 9; n += 1) {
        ivec2 near = clamp(texel + ivec2(n % 3 - 1, n / 3 - 1), ivec2(0), last);
        vec3 around = texelFetch(light, near, 0).rgb;
        lowest = min(lowest, around);
        highest = max(highest, around);
    }
    return predicted(model, fresh, lowest, highest, frames_of(count), is_delayed);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 film = texelFetch(light, texel, 0);
    vec3 fresh = film.rgb;
    float count = film.a;
    Prediction made = first_prediction(fresh, frames_of(count));
    Model model = model_at(texel);
    if (has_history && model.views > 0.0) {
        if (count > 0.0) made = with_film(model, fresh, count, texel);
        else made = of_no_sample(model);
    } else if (count <= 0.0) {
        made.model.views = 0.0;  // the model is not used
    }
    prediction = vec4(made.radiance, made.weight);
    Rows rows = rows_of(made.model);
    for (int j = 0; j < 7; j += 1) new_row[j] = rows.row[j];
}
