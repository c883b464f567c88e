// Russian roulette: paths that carry little end at random.

// Divides the survivors' throughput by their chance: another variance, the same mean. It applies
// once the throughput is below 1 / keep. Chances are multiples of 2^-16, which random numbers of 20 bits, as Sobol's are,
// meet exactly.
const float CHANCES = 65536.0;

bool ends_at_random(precise inout vec3 throughput, float keep, precise inout Sampler rng) {
    precise float brightest = max(throughput.x, max(throughput.y, throughput.z));
    precise float survival = min(ceil(keep * CHANCES * brightest) / CHANCES, 1.0);
    record_survival(survival);
    if (next_1d(rng) >= survival) return true;
    throughput /= survival;
    return false;
}
