// One path from the camera: radiance in linear sRGB. Lamps are found by scattering alone, and no
// roulette ends a path. The twin of shaders_glsl/integrators/path.glsl with the method naive.

struct Path {
    ray: Ray,           // its next segment
    throughput: vec3f,
    scale: f32,         // of radiance by refraction
    radiance: vec3f,    // gathered so far
    depth: i32,         // scattering events so far
}

fn background(direction: vec3f) -> vec3f {
    let t = 0.5 * exact(direction.y + 1.0);
    let span = settings.background_top - settings.background_bottom;
    return settings.background_bottom + exact3(t * span);
}

fn start_path(ray: Ray) -> Path {
    return Path(ray, vec3f(1.0), 1.0, vec3f(0.0), 0);
}

// Scatters at a surface; false when the path ends.
fn scatter_path(
    path: ptr<function, Path>, surface: Surface, material: Material, rng: ptr<function, Sampler>
) -> bool {
    let side = select(-1.0, 1.0, dot3((*path).ray.direction, surface.normal) < 0.0);  // 1: outer
    let around = frame_around(side * surface.normal);
    let vertex = Vertex(around, to_local(around, -(*path).ray.direction), material);
    let next = sample_material(vertex, side > 0.0, rng);
    (*path).throughput *= next.weight;
    if (all((*path).throughput == vec3f(0.0))) {
        return false;
    }
    (*path).scale *= next.scale;
    let inward = (side < 0.0) != next.crosses;
    (*path).ray = Ray(surface.position, next.direction, surface.shape, inward);
    (*path).depth += 1;
    return true;
}

// Follows one segment; false when the path ends with it.
fn extend_path(path: ptr<function, Path>, rng: ptr<function, Sampler>) -> bool {
    let hit = closest_hit((*path).ray);
    let share = (*path).scale * (*path).throughput;
    if (hit.shape == NO_SHAPE) {
        (*path).radiance += exact3(share * background((*path).ray.direction));
        return false;
    }
    let surface = surface_at((*path).ray, hit);
    let material = materials[surface.material];
    (*path).radiance += exact3(share * material.emission);
    if ((*path).depth == settings.bounces) {
        return false;
    }
    return scatter_path(path, surface, material, rng);
}

// The radiance of one sample.
fn trace(place: vec2i, seed: u32) -> vec3f {
    var rng = make_sampler(seed);
    var path = start_path(camera_ray(vec2f(settings.size), vec2f(place), &rng));
    while (extend_path(&path, &rng)) {}
    return path.radiance;
}
