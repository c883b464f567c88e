// A thin lens, seen from the centre of which the scene is described.
// The twin of shaders_glsl/integrators/camera.glsl.

struct Ray {
    origin: vec3f,
    direction: vec3f,  // unit
    leaves: i32,       // the shape that it starts on, or NO_SHAPE
    inward: bool,      // whether it runs into the sphere that it starts on
}

fn camera_ray(size: vec2f, pixel: vec2f, rng: ptr<function, Sampler>) -> Ray {
    let jitter = next_2d(rng);
    let x = (2.0 * (pixel.x + jitter.x) / size.x - 1.0) * camera.tan_x;
    let y = (1.0 - 2.0 * (pixel.y + jitter.y) / size.y) * camera.tan_y;
    var direction = exact3(camera.forward + exact3(x * camera.right)) + exact3(y * camera.up);
    var origin = vec3f(0.0);
    if (camera.lens_radius > 0.0) {
        let u = next_2d(rng);
        let disk = sample_disk(u);
        let offset = exact3(disk.x * camera.right) + exact3(disk.y * camera.up);
        origin = camera.lens_radius * offset;
        direction -= exact3(camera.tan_lens * offset);  // still through the same point in focus
    }
    return Ray(origin, normalized(direction), NO_SHAPE, false);
}
