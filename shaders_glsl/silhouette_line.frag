// A line around the pixels that an object covers: bright, and dark on its far side, so that it is visible on any
// picture. The object itself stays free.

uniform sampler2D mask;
uniform float width;  // of the bright line, in pixels

out vec4 color;

const int REACH = 4;
const vec3 BRIGHT = vec3(1.0, 0.62, 0.1);

bool is_covered(ivec2 texel) {
    ivec2 last = textureSize(mask, 0) - 1;
    return texelFetch(mask, clamp(texel, ivec2(0), last), 0).r > 0.5;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    float nearest = float(2 * REACH);
    for (int y = -REACH; y <= REACH; y += 1) {
        for (int x = -REACH; x <= REACH; x += 1) {
            if (is_covered(texel + ivec2(x, y))) nearest = min(nearest, length(vec2(float(x), float(y))));
        }
    }
    float line = clamp(width + 0.5 - nearest, 0.0, 1.0);
    float rim = clamp(2.0 * width + 0.5 - nearest, 0.0, 1.0);
    float alpha = max(line, 0.6 * rim);
    color = nearest == 0.0 || rim == 0.0 ? vec4(0.0) : vec4(BRIGHT * (line / alpha), alpha);
}
