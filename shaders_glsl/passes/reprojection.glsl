// From a pixel of one view to the place in another view where the same surface was seen.
//
// Views store surfaces as in integrators/middle_surface.glsl. `before` is the other view, and `history` is the
// picture that was shown of it. Places are in its texels, with their middles at halves; row 0 is on top.
// Entry files declare the inputs: reproject.frag lists them, glrt/rendering/history/reprojection.py fills them.

#include "passes/surface_flags.glsl"

const float SAME_PLACE = 0.02;                // most distance off the plane of the surface, over that from the eye
const float SAME_NORMAL = 0.906307787;        // cosine of 25 degrees
const float WHOLE_PIXEL = 1.0 / 512.0;        // of a pixel: a place this near to a middle is at the middle
const float LEAST_SHARE = 0.01;                // least weight of the nearest four texels together
const vec2 NO_PLACE = vec2(-1.0);
const ivec2 NO_TEXEL = ivec2(-1);

// The row of `motion` for an object, by 1 + its number; -1 for one that did not move. Rows are in order of numbers.
int row_of(float object) {
    int low = 0;
    int high = moved;
    while (low < high) {
        int middle = (low + high) / 2;
        if (texelFetch(motion, ivec2(0, middle), 0).x < object) low = middle + 1;
        else high = middle;
    }
    if (low == moved || texelFetch(motion, ivec2(0, low), 0).x != object) return -1;
    return low;
}

// Three texels of a row as a matrix, times a vector.
vec3 by_texels(int row, int first, vec4 vector) {
    vec3 product = vec3(dot(texelFetch(motion, ivec2(first, row), 0), vector),
                        dot(texelFetch(motion, ivec2(first + 1, row), 0), vector),
                        dot(texelFetch(motion, ivec2(first + 2, row), 0), vector));
    return product;
}

// Whether the surface at a texel of this view is of a triangle that was deformed.
bool is_deformed(ivec2 texel) {
    return HAS_DEFORMED && texelFetch(deformed, texel, 0).w > 0.0;
}

// A surface relative to the eye before; a direction where the ray meets nothing, which is infinitely far.
vec3 seen_before(ivec2 texel, vec4 surface) {
    if (surface.w <= 0.0) return surface.xyz;
    if (is_deformed(texel)) return texelFetch(deformed, texel, 0).xyz;
    int row = row_of(surface.w);
    if (row < 0) return surface.xyz + eye_shift;
    return by_texels(row, 1, vec4(surface.xyz, 1.0));
}

// The normal that a surface had before; flags stay.
vec4 facing_before(ivec2 texel, vec4 surface, vec4 facing) {
    if (is_deformed(texel)) return texelFetch(deformed_normal, texel, 0);
    int row = surface.w > 0.0 ? row_of(surface.w) : -1;
    if (row < 0) return facing;
    return vec4(normalize(by_texels(row, 4, vec4(facing.xyz, 0.0))), facing.w);
}

// Its place in the view before; NO_PLACE behind the eye of that view and outside its picture.
vec2 place_before(vec3 seen) {
    float depth = dot(seen, before_forward);
    if (depth <= 0.0) return NO_PLACE;
    vec2 at = vec2(dot(seen, before_right) / dot(before_right, before_right),
                           dot(seen, before_up) / dot(before_up, before_up)) / depth;
    vec2 place = vec2(0.5 + 0.5 * at.x, 0.5 - 0.5 * at.y) * before_frame - before_origin;
    vec2 size = vec2(textureSize(before_position, 0));
    bool is_inside = all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, size));
    return is_inside ? place : NO_PLACE;
}

// Whether a surface of the view before is of the same object and lies in the plane of the surface `seen`.
bool is_there(vec4 there, float object, vec3 seen, vec3 facing) {
    if (there.w != object || object < 0.0) return false;
    float off = abs(dot(there.xyz - seen, facing));
    return off <= SAME_PLACE * length(seen);
}

// Whether a texel of the view before shows the same surface: the same object, at the same depth, with a similar normal.
// A texel at an edge also contains light of another surface. Only another texel at an edge may take that light, and
// only one at the edge of a lamp may take light of a lamp.
bool holds(ivec2 texel, float object, vec3 seen, vec4 facing) {
    ivec2 size = textureSize(before_position, 0);
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) return false;
    if (!is_there(texelFetch(before_position, texel, 0), object, seen, facing.xyz)) return false;
    vec4 other = texelFetch(before_normal, texel, 0);
    if ((has_flag(other, LAMP_EDGE) && !has_flag(facing, LAMP_EDGE)) || (has_flag(other, EDGE) && !has_flag(facing, EDGE))) return false;
    return dot(other.xyz, facing.xyz) >= SAME_NORMAL;
}

// The nearest of the four texels around a place that show the same surface; NO_TEXEL if none does.
ivec2 texel_at(vec2 place, float object, vec3 seen, vec4 facing) {
    ivec2 corner = ivec2(floor(place - 0.5));
    ivec2 nearest = NO_TEXEL;
    float least = 3.0;  // squares of distances are 2 at most
    for (int n = 0; n < 4; n += 1) {
        ivec2 texel = corner + ivec2(n & 1, n >> 1);
        vec2 off = place - vec2(texel) - 0.5;
        float distance = dot(off, off);
        if (distance < least && holds(texel, object, seen, facing)) {
            nearest = texel;
            least = distance;
        }
    }
    return nearest;
}

// Weights of Catmull and Rom's spline for texels at -1, 0, 1, 2 from one at `t` of the way from 0 to 1.
vec4 spline_weights(float t) {
    float t2 = t * t;
    float t3 = t2 * t;
    vec4 doubled = vec4(2.0 * t2 - t3 - t, 3.0 * t3 - 5.0 * t2 + 2.0,
                                4.0 * t2 - 3.0 * t3 + t, t3 - t2);
    return 0.5 * doubled;
}

// The spline's value between texels around a place. All of them have been found to show the same surface.
vec4 splined(sampler2D picture, ivec2 corner, vec2 share) {
    ivec2 last = textureSize(picture, 0) - 1;
    vec4 across = spline_weights(share.x);
    vec4 down = spline_weights(share.y);
    vec4 sum = vec4(0.0);
    for (int j = 0; j < 4; j += 1) {
        for (int i = 0; i < 4; i += 1) {
            ivec2 texel = clamp(corner + ivec2(i - 1, j - 1), ivec2(0), last);
            sum += across[i] * down[j] * texelFetch(picture, texel, 0);
        }
    }
    return sum;
}

// Whether the twelve texels around the four in the middle, as far as they exist, are of the same surface.
bool are_around(ivec2 corner, float object, vec3 seen, vec4 facing) {
    ivec2 last = textureSize(before_position, 0) - 1;
    for (int n = 0; n < 16; n += 1) {
        if (n == 5 || n == 6 || n == 9 || n == 10) continue;
        ivec2 texel = clamp(corner + ivec2(n % 4 - 1, n / 4 - 1), ivec2(0), last);
        if (!is_there(texelFetch(before_position, texel, 0), object, seen, facing.xyz)) return false;
    }
    return true;
}

// The history at a place of a surface: radiance, and the samples that it stands for, 0 where the surface was not seen.
// It is exact in the middle of a texel. Between texels that all show the surface it follows a spline; otherwise it is
// the weighted mean of the nearest four texels that show it.
vec4 history_at(sampler2D history, vec2 place, float object, vec3 seen, vec4 facing) {
    vec2 from_middle = place - 0.5;
    ivec2 nearest = ivec2(floor(place));
    vec2 off = abs(place - vec2(nearest) - 0.5);
    if (all(lessThanEqual(off, vec2(WHOLE_PIXEL)))) {
        return holds(nearest, object, seen, facing) ? texelFetch(history, nearest, 0) : vec4(0.0);
    }
    ivec2 corner = ivec2(floor(from_middle));
    vec2 share = from_middle - vec2(corner);
    vec3 sum = vec3(0.0);
    float total = 0.0;
    float rarity = 0.0;  // mean of 1 / samples
    int count = 0;
    for (int n = 0; n < 4; n += 1) {
        ivec2 side = ivec2(n & 1, n >> 1);
        if (!holds(corner + side, object, seen, facing)) continue;
        vec2 parts = mix(1.0 - share, share, vec2(side));
        float weight = parts.x * parts.y;
        vec4 there = texelFetch(history, corner + side, 0);
        if (there.a <= 0.0) continue;
        sum += weight * there.rgb;
        rarity += weight / there.a;
        total += weight;
        count += 1;
    }
    if (total <= LEAST_SHARE) return vec4(0.0);
    float samples = total / rarity;
    if (count == 4 && are_around(corner, object, seen, facing)) return vec4(splined(history, corner, share).rgb, samples);
    return vec4(sum / total, samples);
}
