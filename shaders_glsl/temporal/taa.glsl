// Temporal antialiasing: an exponential mean over views, with a history that is kept within the range of the
// pixels around. Yang, Liu, Salvi, "A Survey of Temporal Antialiasing Techniques" (2020). The limits are
// those of Salvi, "An Excursion in Temporal Supersampling" (2016): mean and deviation of the neighbourhood,
// in YCoCg.

vec3 ycocg_of(vec3 rgb) {
    vec3 ycocg = vec3(0.25 * rgb.r + 0.5 * rgb.g + 0.25 * rgb.b, 0.5 * (rgb.r - rgb.b),
                              0.5 * rgb.g - 0.25 * (rgb.r + rgb.b));
    return ycocg;
}

vec3 rgb_of(vec3 ycocg) {
    float grey = ycocg.x - ycocg.z;
    vec3 rgb = vec3(grey + ycocg.y, ycocg.x + ycocg.z, grey - ycocg.y);
    return rgb;
}

// The point of a box that is nearest to a colour on its way to the middle.
vec3 clipped(vec3 color, vec3 middle, vec3 reach) {
    vec3 off = color - middle;
    float most = 1.0;
    for (int i = 0; i < 3; i += 1) {
        if (abs(off[i]) > reach[i]) most = min(most, reach[i] / abs(off[i]));
    }
    vec3 inside = middle + most * off;
    return inside;
}

// The share of `count` new samples in their mean with a history that stands for `known` samples. It is their part of
// all samples, but at least their share in an exponential mean that gives each sample `least`.
float share_of(float count, float known, float least) {
    float exponential = 1.0 - pow(1.0 - least, count);
    return max(count / (known + count), exponential);
}

vec4 blended(vec4 known, vec3 light, float count, float least) {
    float share = share_of(count, known.a, least);
    vec3 mean = known.rgb + share * (light - known.rgb);
    return vec4(mean, known.a + count);
}
