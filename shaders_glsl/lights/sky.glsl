// Light from infinitely far away: a gradient over the height of a direction. HAS_HORIZON: two, each from
// the horizon to a pole.

vec3 background(vec3 direction) {
    if (HAS_HORIZON) {
        precise vec3 pole = direction.y < 0.0 ? frame.background_bottom : frame.background_top;
        precise vec3 mixed = frame.background_horizon + abs(direction.y) * (pole - frame.background_horizon);
        return mixed;
    }
    precise float t = 0.5 * (direction.y + 1.0);
    precise vec3 radiance = frame.background_bottom + t * (frame.background_top - frame.background_bottom);
    return radiance;
}

// From 0 to PI, of a sine that is not below 0.
float angle_of(float sine, float cosine) {
    precise float size = abs(cosine);
    precise float acute = sine < size ? small_angle(sine / size) : 0.5 * PI - small_angle(size / sine);
    precise float angle = cosine < 0.0 ? PI - acute : acute;
    return angle;
}

// Irradiance over PI of a surface that sees all of its half of the sky. Of one gradient that is the
// radiance two thirds of the way up along the normal. Of two, each half of the sky adds what two
// clamped cosines at an angle a have in common: 2/3 (sin a + (PI - a) cos a).
vec3 unhidden_sky(vec3 normal) {
    precise vec3 two_thirds_up = 2.0 / 3.0 * normal;
    if (!HAS_HORIZON) return background(two_thirds_up);
    precise float sine = sqrt(normal.x * normal.x + normal.z * normal.z);
    precise float angle = angle_of(sine, normal.y);
    precise float above = 2.0 / (3.0 * PI) * (sine + (PI - angle) * normal.y);
    precise float below = 2.0 / (3.0 * PI) * (sine - angle * normal.y);
    precise vec3 rise = frame.background_top - frame.background_horizon;
    precise vec3 fall = frame.background_bottom - frame.background_horizon;
    precise vec3 mean = frame.background_horizon + above * rise + below * fall;
    return mean;
}
