// Colours along a scale, from 0 to 1.

const int COLORS = 11;
uniform vec3 colors[COLORS];  // sRGB

vec3 color_at(float share) {
    precise float at = clamp(share, 0.0, 1.0) * float(COLORS - 1);
    int below = min(int(at), COLORS - 2);
    return mix(colors[below], colors[below + 1], at - float(below));
}
