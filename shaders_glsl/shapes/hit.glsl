// Hits of rays.

const float FAR = 3.402823466e38;

// Like min and max, without their test for NaN on llvmpipe: that takes three instructions, and this takes one.
float lesser(float a, float b) { return a < b ? a : b; }
float larger(float a, float b) { return a > b ? a : b; }

struct Hit {
    float distance;
    int shape;
};

struct Surface {
    vec3 position;
    vec3 normal;   // unit; outward on a shape with an inside, else the shape's own
    int shape;
    int material;
    int light;
};

// Some drivers end loops early, silently (glrt/gpu/driver_checks.py); see add_samples.
bool loop_was_cut = false;

void note_end(int reached, int end) {
    if (reached < end) loop_was_cut = true;
}

// Used where no kind of shape was compiled in: nothing calls it there.
Surface no_surface() {
    return Surface(vec3(0.0), vec3(0.0), NO_SHAPE, 0, NO_LIGHT);
}
