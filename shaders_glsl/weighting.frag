// A film under weights: the sum of its layers, or its mean, each times a factor, and the light of particles. Film row 0
// is on top.

#include "film/most_layers.glsl"

uniform sampler2D mean;
uniform sampler2D layers;       // side by side: over one half of the observations, below over the other half
uniform int layer_count;        // 0: only the mean is weighed
uniform vec3 weights[MOST_LAYERS];
uniform sampler2D particles;    // light of particles, with its layers next to it
uniform bool has_particles;

in vec2 place;
out vec4 color;

vec3 layer_mean(ivec2 texel, int layer) {
    ivec2 size = textureSize(mean, 0);
    vec4 one = texelFetch(layers, size * ivec2(layer, 0) + texel, 0);
    vec4 other = texelFetch(layers, size * ivec2(layer, 1) + texel, 0);
    float count = max(one.a + other.a, 1.0);
    return one.rgb * (one.a / count) + other.rgb * (other.a / count);
}

void main() {
    ivec2 size = textureSize(mean, 0);
    ivec2 texel = ivec2(gl_FragCoord.xy);  // the target is as large as the film
    vec3 sum = vec3(0.0);
    for (int i = 0; i < layer_count; i += 1) sum += weights[i] * layer_mean(texel, i);
    if (layer_count == 0) sum = weights[0] * texelFetch(mean, min(texel, size - 1), 0).rgb;
    if (has_particles && layer_count == 0) sum += weights[0] * texelFetch(particles, min(texel, size - 1), 0).rgb;
    if (has_particles) {
        for (int i = 0; i < layer_count; i += 1) {
            sum += weights[i] * texelFetch(particles, texel + ivec2((i + 1) * size.x, 0), 0).rgb;
        }
    }
    color = vec4(sum, 1.0);
}
