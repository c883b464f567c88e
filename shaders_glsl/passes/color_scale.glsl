// Colours along a scale.

const int COLORS = 11;

// The colour at a share of the scale, from 0 to 1; colours are sRGB.
vec3 color_at(vec3 colors[COLORS], float share) {
    float at = clamp(share, 0.0, 1.0) * float(COLORS - 1);
    int below = min(int(at), COLORS - 2);
    vec3 color = colors[below] + (at - float(below)) * (colors[below + 1] - colors[below]);
    return color;
}
