// Which of two shapes a ray sees.

// Whether a shape at t, above 0, is seen and not what was hit so far.
bool is_nearer(Ray ray, float t, int shape, Hit hit) {
    if (HAS_COINCIDENT) return comes_before(ray, t, shape, hit);
    return t < hit.distance;
}

// How far a shape that takes the place of a hit may lie.
float farthest(Ray ray, Hit hit) {
    precise float most = hit.distance;
    if (HAS_COINCIDENT) most += tie_length(ray);
    return most;
}
