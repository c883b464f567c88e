// The weight of one of two ways to sample the same light (Veach 1997, eq. 9.14): p_a^2 / (p_a^2 + p_b^2). It is written
// so that no square overflows to NaN; p_a is above 0.
float power_heuristic(float p_a, float p_b) {
    float ratio = p_b / p_a;
    float weight = 1.0 / (1.0 + ratio * ratio);
    return weight;
}
