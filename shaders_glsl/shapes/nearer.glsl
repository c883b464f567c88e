// The order of hits: which of two shapes a ray sees.

// Whether a ray sees a shape at t, above 0, instead of the nearest hit so far.
bool is_nearer(Ray ray, float t, int shape, Hit hit) {
    if (HAS_COINCIDENT) return comes_before(ray, t, shape, hit);
    return t < hit.distance;
}

// The largest distance at which a shape may replace a hit.
float farthest(Ray ray, Hit hit) {
    float most = hit.distance;
    if (HAS_COINCIDENT) most += tie_length(ray);
    return most;
}
