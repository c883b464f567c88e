// Weighted recursive least squares: radiance of a pixel as a linear function of its own history.
// Iglesias-Guitian, Mane, Moon, "Real-Time Denoising of Volumetric Path Tracing for Direct Volume
// Rendering" (2020), with guards: weights are never 0, the covariance is bounded, and a model that is
// not finite begins again.

const float FEATURE_SHARE = 0.75;   // share of the old feature in the new one, after one frame
const float WEIGHT_WIDTH = 0.75;    // h: relative distance at which a sample's weight is 1 / e
const float LEAST_RADIANCE = 1e-4;  // added to a radiance that a distance is divided by
const float LEAST_WEIGHT = 1e-12;

struct Model {
    vec3 feature;  // z: radiance, averaged exponentially over frames
    float views;   // views that it has seen
    Fit fit;
};

struct Prediction {
    Model model;
    vec3 radiance;
    float weight;  // of the sample
};

float relative_distance(vec3 a, vec3 b) {
    float least = min(length(a), length(b)) + LEAST_RADIANCE;
    float distance = length(a - b) / least;
    return distance;
}

// A sample that is far from its feature is an outlier.
float sample_weight(vec3 radiance, vec3 feature) {
    float distance = relative_distance(radiance, feature) / WEIGHT_WIDTH;
    float weight = exp(-distance * distance);
    return max(weight, LEAST_WEIGHT);
}

// The model after the mean of `frames` first frames. Frames after the first show that the mean is right, but give no
// information about slopes.
Prediction first_prediction(vec3 radiance, float frames) {
    Fit fit = new_fit(radiance);
    if (frames > 1.0) fit = corrected(fit, vec4(1.0, radiance), radiance, frames - 1.0);
    return Prediction(Model(radiance, 1.0, fit), radiance, 1.0);
}

// The model after the mean `radiance` of so many `frames` of a view. Its neighbourhood holds values from
// `lowest` to `highest`. The published predictor is the feature of this view, which contains the sample
// itself; the delayed predictor is the feature of the frame before.
Prediction predicted(Model before, vec3 radiance, vec3 lowest, vec3 highest, float frames, bool is_delayed) {
    vec3 off = clamp(before.feature, lowest, highest) - radiance;
    vec3 feature = radiance + exp(log(FEATURE_SHARE) * frames) * off;
    vec3 predictor = feature;
    if (is_delayed) {
        if (frames > 1.0) predictor = radiance + exp(log(FEATURE_SHARE) * (frames - 1.0)) * off;
        else predictor = before.feature;
    }
    vec4 p = vec4(1.0, predictor);
    float weight = sample_weight(radiance, predictor);
    Fit fit = corrected(before.fit, p, radiance, weight * frames);
    vec3 prediction = fit.slopes * p;
    bool is_known = is_finite(prediction) && is_finite(feature) && is_finite_fit(fit);
    if (!is_known) return first_prediction(radiance, frames);
    return Prediction(Model(feature, before.views + 1.0, fit), prediction, weight);
}
