// The ray through the middle of a pixel and the middle of the lens; `place`: pixel in the full frame.

Ray middle_ray(ivec2 place) {
    vec2 at = (vec2(place) + 0.5) / vec2(frame.size);
    vec3 direction = frame.camera.forward + (2.0 * at.x - 1.0) * frame.camera.tan_x * frame.camera.right
                           + (1.0 - 2.0 * at.y) * frame.camera.tan_y * frame.camera.up;
    vec3 unit_direction = normalized(direction);
    return Ray(vec3(0.0), unit_direction, NO_SHAPE, false);
}
