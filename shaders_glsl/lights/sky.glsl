// Light from infinitely far away: a gradient over the height of a direction, or an image. HAS_HORIZON: two
// gradients, each from the horizon to a pole.

// The image of the sky shows all directions: the top row is +y, the middle column -z, and three quarters of
// the width +x. It is bilinear between the middles of four pixels, and has no edge around the vertical axis.

struct SkyPlace {
    ivec2 corner;  // the upper left pixel; in row -1 above the first row
    vec2 share;    // share of the way to the lower right pixel
};

struct SkyPatch {
    vec3 left_above;  // the pixels around it
    vec3 right_above;
    vec3 left_below;
    vec3 right_below;
};

SkyPlace sky_place(vec3 direction) {
    float turns = turns_of(direction) + frame.background_turn;
    vec2 place = vec2(turns, descent_of(direction)) * vec2(environment_size()) - 0.5;
    vec2 corner = floor(place);
    vec2 share = place - corner;
    return SkyPlace(ivec2(corner), share);
}

SkyPatch sky_patch(ivec2 corner) {
    ivec2 size = environment_size();
    ivec2 columns = (ivec2(corner.x, corner.x + 1) + size.x) % size.x;
    ivec2 rows = clamp(ivec2(corner.y, corner.y + 1), 0, size.y - 1);
    vec3 left_above = environment_pixel(columns.x, rows.x);
    vec3 right_above = environment_pixel(columns.y, rows.x);
    vec3 left_below = environment_pixel(columns.x, rows.y);
    vec3 right_below = environment_pixel(columns.y, rows.y);
    return SkyPatch(left_above, right_above, left_below, right_below);
}

vec3 radiance_between(SkyPatch around, vec2 share) {
    vec3 above = around.left_above + share.x * (around.right_above - around.left_above);
    vec3 below = around.left_below + share.x * (around.right_below - around.left_below);
    vec3 radiance = above + share.y * (below - above);
    return radiance;
}

vec3 environment(vec3 direction) {
    SkyPlace place = sky_place(direction);
    return radiance_between(sky_patch(place.corner), place.share);
}

vec3 background(vec3 direction) {
    if (HAS_ENVIRONMENT) {
        vec3 pictured = frame.background_top * environment(direction);
        return pictured;
    }
    if (HAS_HORIZON) {
        vec3 pole = direction.y < 0.0 ? frame.background_bottom : frame.background_top;
        vec3 mixed = frame.background_horizon + abs(direction.y) * (pole - frame.background_horizon);
        return mixed;
    }
    float t = 0.5 * (direction.y + 1.0);
    vec3 radiance = frame.background_bottom + t * (frame.background_top - frame.background_bottom);
    return radiance;
}

// Irradiance over PI of a surface that sees all of its half of the sky. With one gradient this is the
// radiance two thirds of the way up along the normal. With two, each half of the sky adds the common part
// of two clamped cosines at an angle a: 2/3 (sin a + (PI - a) cos a).
vec3 unhidden_sky(vec3 normal) {
    if (HAS_ENVIRONMENT) return vec3(0.0);  // the classic models leave it out
    vec3 two_thirds_up = 2.0 / 3.0 * normal;
    if (!HAS_HORIZON) return background(two_thirds_up);
    float sine = sqrt(normal.x * normal.x + normal.z * normal.z);
    float angle = angle_of(sine, normal.y);
    float above = 2.0 / (3.0 * PI) * (sine + (PI - angle) * normal.y);
    float below = 2.0 / (3.0 * PI) * (sine - angle * normal.y);
    vec3 rise = frame.background_top - frame.background_horizon;
    vec3 fall = frame.background_bottom - frame.background_horizon;
    vec3 mean = frame.background_horizon + above * rise + below * fall;
    return mean;
}
