// The means of a pixel by the scrambles of its net: independent of each other, and each over all samples of its own.
// Sample number i is of the scramble i % BLOCK.

const int NET = 8;          // scrambles: BLOCK, where HAS_NET
const int NET_COLUMNS = 4;  // of them side by side in a texture

vec4 net_means[NET];  // a: finite samples

// Adds the sample number `index`, from 0; a sample that is not finite is left out.
void add_to_net(inout Pixel pixel, vec3 x, int index) {
    if (!is_finite(x)) return;
    pixel.count += 1.0;
    pixel.mean = next_mean(pixel.mean, x, pixel.count);
    int own = index % NET;
    vec4 held = net_means[0];
    for (int i = 1; i < NET; i += 1) {
        if (i == own) held = net_means[i];
    }
    held.a += 1.0;
    held.rgb = next_mean(held.rgb, x, held.a);
    for (int i = 0; i < NET; i += 1) {
        if (i == own) net_means[i] = held;
    }
}

// Takes the variance of an observation, (n - 1) times that of the mean, from the n scrambles that have samples. Their
// shares w of all samples may differ: sum(w^2 (m - mean)^2) / (1 - sum(w^2)) is the variance of the mean if samples are
// independent, and for any points if the shares are equal.
void judge_net(inout Pixel pixel) {
    vec3 squares = vec3(0.0);
    float even = 0.0;
    pixel.observations = 0.0;
    for (int i = 0; i < NET; i += 1) {
        float share = net_means[i].a / max(pixel.count, 1.0);
        vec3 away = share * (net_means[i].rgb - pixel.mean);
        squares += away * away;
        even += share * share;
        if (net_means[i].a > 0.0) pixel.observations += 1.0;
    }
    pixel.variance = vec3(0.0);
    if (pixel.observations > 1.0) pixel.variance = squares * ((pixel.observations - 1.0) / (1.0 - even));
}
