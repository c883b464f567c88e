// Recursive least squares: radiance is predicted by slopes from p, and the slopes are fitted to all frames so
// far. Errors count by FORGETTING to the power of their age in frames, and by the weight of their sample.
//
// The covariance of the slopes is kept as U D U^T, U unit upper triangular and D diagonal (Bierman,
// "Factorization Methods for Discrete Sequential Estimation", 1977, chapter V). So it stays symmetric and
// positive. The usual P = (P - g p^T P) / lambda does not in float32. Where the predictor varies only in
// one direction, as in grey light, P grows by 1 / lambda a frame in all others, and its differences lose
// their digits.

const float FORGETTING = 0.998;         // lambda: weight of an error one frame later
const float START_COVARIANCE = 1000.0;  // delta: of each slope in a new fit
const float MOST_TRACE = 4.0 * START_COVARIANCE;

struct Fit {
    mat4x3 slopes;  // of radiance: a column for 1, and one for each channel of p
    vec4 spread;    // D
    mat4 factor;    // U
};

Fit new_fit(vec3 radiance) {
    mat4x3 slopes = mat4x3(radiance, vec3(0.0), vec3(0.0), vec3(0.0));
    return Fit(slopes, vec4(START_COVARIANCE), mat4(1.0));
}

// Trace of the covariance.
float trace(Fit fit) {
    float sum = 0.0;
    for (int j = 0; j < 4; j += 1) sum += fit.spread[j] * dot(fit.factor[j], fit.factor[j]);
    return sum;
}

// Limits the trace. Where a fit learns nothing, endless forgetting would end in an overflow. Before that, the
// first change of the light could give the slopes any value.
Fit limited(Fit before) {
    Fit fit = before;
    float sum = trace(before);
    if (sum > MOST_TRACE) fit.spread *= MOST_TRACE / sum;
    return fit;
}

// The fit after one more sample.
Fit corrected(Fit before, vec4 p, vec3 radiance, float weight) {
    Fit fit = before;
    vec4 along = p * before.factor;  // U^T p
    vec4 scaled = before.spread * along;
    vec4 gain = vec4(0.0);
    float sum = FORGETTING / weight;  // grows up to FORGETTING / weight + p^T P p
    for (int j = 0; j < 4; j += 1) {
        float next = sum + along[j] * scaled[j];
        fit.spread[j] = before.spread[j] * (sum / next) / FORGETTING;
        fit.factor[j] = before.factor[j] - gain * (along[j] / sum);
        gain += before.factor[j] * scaled[j];
        sum = next;
    }
    vec3 error = radiance - before.slopes * p;
    fit.slopes += outerProduct(error, gain / sum);
    return limited(fit);
}

bool is_finite_fit(Fit fit) {
    bool is_known = is_finite(vec3(trace(fit)));
    for (int j = 0; j < 4; j += 1) is_known = is_known && is_finite(fit.slopes[j]);
    return is_known;
}
