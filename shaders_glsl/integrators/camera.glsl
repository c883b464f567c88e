// Rays of a camera with a thin lens. The centre of the lens is the origin of the scene's coordinates.

Ray camera_ray(Camera camera, vec2 size, vec2 pixel, inout Sampler rng) {
    vec2 jitter = next_2d(rng);
    float x = (2.0 * (pixel.x + jitter.x) / size.x - 1.0) * camera.tan_x;
    float y = (1.0 - 2.0 * (pixel.y + jitter.y) / size.y) * camera.tan_y;
    vec3 direction = camera.forward + x * camera.right + y * camera.up;
    vec3 origin = vec3(0.0);
    if (HAS_LENS) {
        vec2 u = next_2d(rng);
        vec2 disk = sample_disk(u);
        vec3 offset = disk.x * camera.right + disk.y * camera.up;
        origin = camera.lens_radius * offset;
        direction -= camera.tan_lens * offset;  // the ray still passes the same point in focus
    }
    vec3 unit_direction = normalized(direction);
    return Ray(origin, unit_direction, NO_SHAPE, false);
}
