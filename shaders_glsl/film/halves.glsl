// Light of a pixel by layers: means over every second observation, and means over the others.
// The difference of the two gives the error of their mean, for any weights of the layers.
struct Layers {
    vec3 means[2 * MOST_LAYERS];
    float counts[2];  // finite samples
};

Layers empty_layers() {
    Layers layers;
    for (int i = 0; i < 2 * LAYERS; i += 1) layers.means[i] = vec3(0.0);
    layers.counts[0] = 0.0;
    layers.counts[1] = 0.0;
    return layers;
}

// Adds the light of the sample number `index` by layers.
void add_layers(inout Layers layers, Path path, int index) {
    if (!is_finite(path.radiance)) return;
    int side = index / BLOCK % 2;
    layers.counts[side] += 1.0;
    for (int i = 0; i < 2 * LAYERS; i += 1) {
        if (i / DIVISOR != side) continue;
        vec3 light = path.layers[i % DIVISOR];
        layers.means[i] = next_mean(layers.means[i], light, layers.counts[side]);
    }
}
