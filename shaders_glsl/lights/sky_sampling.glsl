// Sampling of the image of the sky, in proportion to its brightness times the sine of the angle to the axis,
// since wider pixels cover more sky. Both factors are bilinear between the middles of four pixels; at the
// poles the sine is 0. So there is a density wherever there is light.
//
// The patch between four middles is found in a tree whose nodes hold the sums of their four parts (Clarberg
// et al., "Wavelet Importance Sampling", SIGGRAPH 2005): random numbers that are close stay close. Patches
// above the first and below the last row are half as high.

const float BELOW_ONE = 1.0 - 5.9604644775390625e-8;

// Whether a number lies in the second of two parts of the unit interval. `u` becomes the number within
// its part.
bool is_beyond(inout float u, float first, float second) {
    float target = u * (first + second);
    bool beyond = target >= first && second > 0.0;
    u = beyond ? (target - first) / second : target / first;
    u = min(u, BELOW_ONE);
    return beyond;
}

// Draws a patch and returns its upper left pixel.
ivec2 choose_sky_patch(inout vec2 u) {
    ivec2 size = environment_size();
    int below = findMSB(max(size.x, size.y + 1) - 1) + 1;  // levels of the tree
    ivec2 place = ivec2(0);
    int top = 0;  // row of the texture where the level begins
    for (; below > 0; --below) {
        vec4 parts = sky_part(place.x, top + place.y);
        top += (size.y + (1 << below)) >> below;
        bool is_low = is_beyond(u.y, parts.x + parts.y, parts.z + parts.w);
        vec2 row = is_low ? parts.zw : parts.xy;
        bool is_right = is_beyond(u.x, row.x, row.y);
        place = 2 * place + ivec2(is_right ? 1 : 0, is_low ? 1 : 0);
    }
    note_end(0, below);
    return place - ivec2(0, 1);
}

// A number from 0 to 1 whose density goes linearly from a to b.
float sample_between(float a, float b, float u) {
    float root = a + sqrt(max(a * a + u * (b - a) * (a + b), 0.0));
    if (root == 0.0) return 0.0;
    float x = u * (a + b) / root;
    return x;
}

float brightness(vec3 color) {
    float mean = (color.x + color.y + color.z) / 3.0;
    return mean;
}

// Brightness times the sine at the corners of a patch: left and right above, left and right below.
vec4 sky_corners(SkyPatch around, int row) {
    int rows = environment_size().y;
    float above = row < 0 ? 0.0 : sin(PI * (float(row) + 0.5) / float(rows));
    float below = row + 1 == rows ? 0.0 : sin(PI * (float(row + 1) + 0.5) / float(rows));
    vec2 upper = above * vec2(brightness(around.left_above), brightness(around.right_above));
    vec2 lower = below * vec2(brightness(around.left_below), brightness(around.right_below));
    return vec4(upper, lower);
}

// Bilinear value between the corners; x and y from 0 to 1.
float corners_between(vec4 corners, vec2 place) {
    vec2 column = corners.xz + place.x * (corners.yw - corners.xz);
    float between = column.x + place.y * (column.y - column.x);
    return between;
}

// The density per solid angle where brightness times sine is `weight`; `sine` is that of the direction.
float sky_density(float weight, float sine) {
    float pdf = sine > 0.0 ? weight * frame.sky_density / sine : 0.0;
    return pdf;
}

float pdf_sky(vec3 direction) {
    SkyPlace place = sky_place(direction);
    int row = place.corner.y;
    vec4 corners = sky_corners(sky_patch(place.corner), row);
    float y = place.share.y;
    if (row < 0) y = 2.0 * y - 1.0;
    else if (row + 1 == environment_size().y) y = 2.0 * y;
    float sine = sqrt(direction.x * direction.x + direction.z * direction.z);
    return sky_density(corners_between(corners, vec2(place.share.x, y)), sine);
}

// A sample of the sky from the origin of `ray`, whose direction is ignored.
LightSample sample_sky(Ray ray, inout Sampler rng) {
    vec2 u = next_2d(rng);
    ivec2 size = environment_size();
    ivec2 corner = choose_sky_patch(u);
    SkyPatch around = sky_patch(corner);
    vec4 corners = sky_corners(around, corner.y);
    float y = sample_between(corners.x + corners.y, corners.z + corners.w, u.y);
    vec2 ends = corners.xy + y * (corners.zw - corners.xy);
    float x = sample_between(ends.x, ends.y, u.x);
    vec2 share = vec2(x, y);
    if (corner.y < 0) share.y = 0.5 + 0.5 * y;
    else if (corner.y + 1 == size.y) share.y = 0.5 * y;
    vec2 place = (vec2(corner) + 0.5 + share) / vec2(size);
    float azimuth = 2.0 * PI * (place.x - 0.5 - frame.background_turn);
    float sine = sin(PI * place.y);
    ray.direction = normalized(vec3(sine * sin(azimuth), cos(PI * place.y), -sine * cos(azimuth)));
    vec3 radiance = frame.background_top * radiance_between(around, share);
    float pdf = sky_density(corners_between(corners, vec2(x, y)), sine);
    return LightSample(ray, FAR, pdf, radiance, NO_SHAPE, BACKGROUND_LAYER, NO_LIGHT);
}
