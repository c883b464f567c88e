// Russian roulette: paths of low throughput end at random.

// Division of the survivors' throughput by their chance keeps the mean and changes the variance. It applies once
// the throughput is below 1 / keep. Chances are multiples of 2^-16, so that random numbers of 20 bits, as of Sobol
// sequences, meet them exactly.
const float CHANCES = 65536.0;

bool ends_at_random(inout vec3 throughput, float keep, inout Sampler rng) {
    float brightest = max(throughput.x, max(throughput.y, throughput.z));
    float survival = min(ceil(keep * CHANCES * brightest) / CHANCES, 1.0);
    record_survival(survival);
    if (next_1d(rng) >= survival) return true;
    throughput /= survival;
    return false;
}

// Roulette of paths from the camera. To end paths below a throughput of 1/4 saves more time than it adds variance
// (docs/results/speed.md).
bool roulette_ends(inout vec3 throughput, inout Sampler rng) {
    return ends_at_random(throughput, 4.0, rng);
}
