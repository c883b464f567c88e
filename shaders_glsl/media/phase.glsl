// The phase function of Henyey and Greenstein ("Diffuse radiation in the Galaxy", 1941, eq. 2): how light turns where
// a medium scatters it. It is its own density, so that a sample has the weight 1.

// The density, per solid angle, of a turn from one unit direction to another. The difference of the directions keeps
// the digits of small turns.
float eval_phase(float g, vec3 from, vec3 to) {
    vec3 aside = g < 0.0 ? from + to : from - to;
    float back = 1.0 - abs(g);
    float spread = back * back + abs(g) * dot(aside, aside);
    float density = back * (1.0 + abs(g)) / (4.0 * PI * spread * sqrt(spread));
    return density;
}

// The cosine of a turn by inversion, in a form that does not divide by g.
float sample_turn(float g, float u) {
    float x = 2.0 * u - 1.0;
    float scale = 1.0 + g * x;
    float cosine = (x * (1.0 + g * g) + 0.5 * g * (x * x * (1.0 + g * g) + 3.0 - g * g)) / (scale * scale);
    return clamp(cosine, -1.0, 1.0);
}

vec3 sample_phase(float g, vec3 from, vec2 u) {
    float cosine = sample_turn(g, u.x);
    float sine = sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0));
    float phi = 2.0 * PI * u.y;
    vec3 direction = normalized(frame_around(from) * vec3(sine * cos(phi), sine * sin(phi), cosine));
    return direction;
}
