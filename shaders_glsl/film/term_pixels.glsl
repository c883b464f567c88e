// Statistics of the terms of light of a pixel, of the samples that the picture has.

const Pixel NOTHING = Pixel(vec3(0.0), 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);

Pixel term_pixels[TERMS] = Pixel[TERMS](NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING);

void add_terms(Path path, int index) {
    for (int i = 0; i < TERMS; i += 1) {
        if (!is_kept(i)) continue;
        vec3 light = is_finite(path.radiance) ? path.terms.light[i] : path.radiance;  // the picture leaves it out, too
        add_sample(term_pixels[i], light, index);
    }
}

void drop_from_terms(int index, int end) {
    for (int i = 0; i < TERMS; i += 1) {
        if (is_kept(i)) drop_samples(term_pixels[i], index, end);
    }
}
