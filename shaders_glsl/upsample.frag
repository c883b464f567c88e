// The full picture from the samples of one pixel in k x k, and history (temporal/upsample.glsl).

#include "passes/surface_flags.glsl"
#include "temporal/taa.glsl"
#include "temporal/upsample.glsl"

uniform sampler2D position;       // first surfaces, as in surfaces.glsl
uniform sampler2D normal;
uniform sampler2D first;          // a sample of each sampled pixel; a: 1 if it is finite, 0 elsewhere
uniform sampler2D second;
uniform sampler2D known_own;      // history of the pixel's own samples; a: their number
uniform sampler2D known_guess;    // history of means around; a: the samples that they stand for
uniform bool has_own;
uniform bool has_guess;
uniform bool is_moved;            // history is of another view: images in mirrors have moved
uniform bool is_other_light;      // or of other light
uniform int factor;               // k
uniform ivec2 corner;             // the first sampled pixel

layout(location = 0) out vec4 own;    // mean of the pixel's own samples, and their number
layout(location = 1) out vec4 guess;  // mean of pixels around, and the samples that it stands for
layout(location = 2) out vec4 shown;  // radiance, and the samples that it stands for

const float SAME_PLACE = 0.02;        // as in passes/reprojection.glsl
const float SAME_NORMAL = 0.906307787;
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);

// Sums over the nearest 3 x 3 sampled pixels of the same surface.
struct Around {
    vec3 sum;          // of radiance by weight
    float total;       // of weights
    float squares;     // of weights
    float noise;       // variance of a sample, by weight
    float luma;        // of luminance and its square, by weight
    float luma2;
    float count;
    vec3 color;        // of colours and their squares in YCoCg, each pixel alike
    vec3 color2;
    vec3 nearest;      // radiance of the nearest sampled pixel of any surface
    float distance;    // its square, in pixels
};

// Whether a sampled pixel shows the same surface, by the rules of passes/reprojection.glsl for history. Samples of a
// pixel at an edge may be of another surface: only pixels at edges take them.
bool is_same(vec4 surface, vec4 facing, ivec2 texel) {
    vec4 there = texelFetch(position, texel, 0);
    vec4 other = texelFetch(normal, texel, 0);
    if (there.w != surface.w) return false;
    if (has_flag(other, LAMP_EDGE) && !has_flag(facing, LAMP_EDGE)) return false;
    if (has_flag(other, EDGE) && !has_flag(facing, EDGE)) return false;
    if (surface.w <= 0.0) return true;
    if (abs(dot(there.xyz - surface.xyz, facing.xyz)) > SAME_PLACE * length(surface.xyz)) return false;
    return dot(other.xyz, facing.xyz) >= SAME_NORMAL;
}

// How far a sampled pixel is for a pixel that has no sample of its surface around. Lamps are taken last: they would
// outshine what is next to them.
float stranger_distance(vec2 off, vec4 facing, vec4 other) {
    bool is_lamp = has_flag(other, LAMP | LAMP_EDGE) && !has_flag(facing, LAMP);
    float distance = dot(off, off) + (is_lamp ? 1.0e6 : 0.0);
    return distance;
}

vec3 pair_at(ivec2 texel) {
    vec3 one = texelFetch(first, texel, 0).rgb;
    vec3 mean = one + 0.5 * (texelFetch(second, texel, 0).rgb - one);
    return mean;
}

bool is_sampled(ivec2 texel) {
    return texelFetch(first, texel, 0).a > 0.0 && texelFetch(second, texel, 0).a > 0.0;
}

Around around_of(ivec2 texel, vec4 surface, vec4 facing) {
    ivec2 size = textureSize(position, 0);
    Around found = Around(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, vec3(0.0), vec3(0.0), vec3(0.0), 1.0e9);
    ivec2 middle = ivec2(floor((vec2(texel - corner) + 0.5 * float(factor)) / float(factor)));
    for (int n = 0; n < 9; n += 1) {
        ivec2 near = corner + factor * (middle + ivec2(n % 3 - 1, n / 3 - 1));
        if (near != clamp(near, ivec2(0), size - 1) || !is_sampled(near)) continue;
        vec3 mean = pair_at(near);
        vec2 off = vec2(near - texel);
        float distance = stranger_distance(off, facing, texelFetch(normal, near, 0));
        if (distance < found.distance) {
            found.distance = distance;
            found.nearest = mean;
        }
        if (!is_same(surface, facing, near)) continue;
        float weight = filter_weight(off, float(factor));
        float luma = dot(mean, LUMINANCE);
        float apart = dot(texelFetch(first, near, 0).rgb - texelFetch(second, near, 0).rgb, LUMINANCE);
        vec3 color = ycocg_of(mean);
        found.sum += weight * mean;
        found.total += weight;
        found.squares += weight * weight;
        found.noise += weight * 0.5 * apart * apart;
        found.luma += weight * luma;
        found.luma2 += weight * luma * luma;
        found.count += 1.0;
        found.color += color;
        found.color2 += color * color;
    }
    return found;
}

// The noise of sampled pixels of the same surface around the nearest 3 x 3. Where all of these are dark by chance, their
// pairs show no noise.
float noise_beyond(ivec2 texel, vec4 surface, vec4 facing) {
    ivec2 size = textureSize(position, 0);
    ivec2 middle = ivec2(floor((vec2(texel - corner) + 0.5 * float(factor)) / float(factor)));
    float sum = 0.0;
    float count = 0.0;
    for (int n = 0; n < 25; n += 1) {
        ivec2 step = ivec2(n % 5 - 2, n / 5 - 2);
        ivec2 near = corner + factor * (middle + step);
        if (max(abs(step.x), abs(step.y)) < 2 || near != clamp(near, ivec2(0), size - 1)) continue;
        if (!is_sampled(near) || !is_same(surface, facing, near)) continue;
        float apart = dot(texelFetch(first, near, 0).rgb - texelFetch(second, near, 0).rgb, LUMINANCE);
        sum += 0.5 * apart * apart;
        count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
}

vec4 kept_near(vec4 known, Around around) {
    if (around.count < 2.0 || known.a <= 0.0) return vec4(0.0);
    vec3 middle = around.color / around.count;
    vec3 deviation = sqrt(max(around.color2 / around.count - middle * middle, 0.0));
    vec4 kept = vec4(rgb_of(clipped(ycocg_of(known.rgb), middle, REACH * deviation)), known.a);
    return kept;
}

vec4 own_of(vec4 known, ivec2 texel) {
    if (!is_sampled(texel)) return known;
    return blended(known, pair_at(texel), PAIR, 0.0);
}

vec4 guess_of(vec4 known, Around around) {
    known.a = min(known.a, MOST_GUESSED);
    if (around.total <= 0.0) return known.a > 0.0 ? known : vec4(around.nearest, STRANGER);
    float samples = PAIR * around.total * around.total / around.squares;
    return blended(known, around.sum / around.total, samples, 0.0);
}

// The samples that the guess counts for next to the pixel's own.
float prior_of(Around around, float guessed) {
    float shared_weight = around.squares / (around.total * around.total);
    if (around.count < 2.0 || shared_weight >= 1.0) return 0.0;
    float mean = around.luma / around.total;
    float variance = max(around.luma2 / around.total - mean * mean, 0.0) / (1.0 - shared_weight);
    float noise = around.noise / around.total;
    return prior_samples(noise, detail_of(variance, noise), guessed);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 surface = texelFetch(position, texel, 0);
    vec4 facing = texelFetch(normal, texel, 0);
    Around around = around_of(texel, surface, facing);
    vec4 mine = has_own ? texelFetch(known_own, texel, 0) : vec4(0.0);
    vec4 mean = has_guess ? texelFetch(known_guess, texel, 0) : vec4(0.0);
    bool is_image = has_flag(facing, SPECULAR | BLURRED);
    if (is_other_light || (is_moved && is_image)) {
        mine = kept_near(mine, around);
        mean = kept_near(mean, around);
    }
    if (around.noise <= 0.0) around.noise = around.total * noise_beyond(texel, surface, facing);
    own = own_of(mine, texel);
    guess = guess_of(mean, around);
    float prior = own.a > 0.0 ? prior_of(around, guess.a) : guess.a;
    if (own.a <= 0.0) {
        shown = guess;
        return;
    }
    shown = vec4(own.rgb + prior / (own.a + prior) * (guess.rgb - own.rgb), own.a + prior);
}
