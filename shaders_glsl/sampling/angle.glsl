// Angles by their tangents: the built-in functions differ between drivers.

// atan on 0..1, an odd polynomial whose largest relative error is 1e-7.
float small_angle(float tangent) {
    float q = tangent * tangent;
    float p = 0.0247340375 - 0.00482252624 * q;
    p = p * q - 0.0602030977;
    p = p * q + 0.0996847111;
    p = p * q - 0.140413272;
    p = p * q + 0.19974214;
    p = p * q - 0.333323916;
    float angle = tangent + tangent * (q * p);
    return angle;
}

// The angle, from 0 to PI, of a sine that is not below 0 and its cosine.
float angle_of(float sine, float cosine) {
    float size = abs(cosine);
    float acute = sine < size ? small_angle(sine / size) : 0.5 * PI - small_angle(size / sine);
    float angle = cosine < 0.0 ? PI - acute : acute;
    return angle;
}

// The turn of a direction about the vertical axis, from 0 to 1: -z in the middle, +x at three quarters.
float turns_of(vec3 direction) {
    float azimuth = abs(direction.x) + abs(direction.z) > 0.0 ? angle_of(abs(direction.x), -direction.z) : 0.0;
    float turned = direction.x < 0.0 ? -azimuth : azimuth;
    float turns = 0.5 / PI * turned + 0.5;
    return turns;
}

// The angle of a direction from the zenith, from 0 to 1: 1 is straight down.
float descent_of(vec3 direction) {
    float across = sqrt(direction.x * direction.x + direction.z * direction.z);
    float descent = angle_of(across, direction.y) / PI;
    return descent;
}
