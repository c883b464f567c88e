// The film under a Gaussian filter one pixel wide, as in the paper of temporal/wrls.glsl. In addition, light of another
// object is left out, so that outlines stay sharp.

uniform sampler2D light;     // the film under its weights
uniform sampler2D mean;      // of the film; a: finite samples
uniform float samples;       // of the film
uniform sampler2D position;  // w: 1 + the number of the object behind the middle of the pixel

out vec4 reconstructed;      // radiance, and finite samples of the pixel

const float PIXELS = 0.5;    // standard deviation
const float FEW = 2.0;       // samples as in the paper; with more, neighbours count less, since there is less noise

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(light, 0) - 1;
    float object = texelFetch(position, texel, 0).w;
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int n = 0; n < 9; n += 1) {
        ivec2 off = ivec2(n % 3, n / 3) - 1;
        ivec2 near = texel + off;
        if (near != clamp(near, ivec2(0), last) || texelFetch(position, near, 0).w != object) continue;
        if (texelFetch(mean, near, 0).a <= 0.0) continue;
        float weight = exp(-0.5 * dot(vec2(off), vec2(off)) / (PIXELS * PIXELS));
        if (off != ivec2(0)) weight *= min(FEW / samples, 1.0);
        sum += weight * texelFetch(light, near, 0).rgb;
        total += weight;
    }
    vec3 radiance = total > 0.0 ? sum / total : vec3(0.0);
    reconstructed = vec4(radiance, texelFetch(mean, texel, 0).a);
}
