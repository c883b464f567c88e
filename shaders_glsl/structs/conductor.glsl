// Metal by its complex index of refraction n + i k, in red, green and blue.

const int NO_CONDUCTOR = -1;  // of metal that has a color

struct Conductor {
    vec3 n;
    int spare_a;  // fill the rows
    vec3 k;
    int spare_b;
};
