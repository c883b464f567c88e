// What one sample of each pixel comes by on its way, for tests/wgsl/stages.py. The twin of
// stages.comp.

@group(1) @binding(0) var random: texture_2d<u32>;
@group(1) @binding(1) var<storage, read_write> words: array<u32>;

var<private> at: i32;

fn put(word: u32) {
    words[at] = word;
    at += 1;
}

fn put_float(x: f32) {
    put(bitcast<u32>(x));
}

fn put_vector(v: vec3f) {
    put_float(v.x);
    put_float(v.y);
    put_float(v.z);
}

fn put_hit(ray: Ray) {
    let hit = closest_hit(ray);
    put(u32(hit.shape));
    put_float(hit.distance);
    if (hit.shape == NO_SHAPE) {
        return;
    }
    let surface = surface_at(ray, hit);
    put(u32(surface.material));
    put_vector(surface.position);
    put_vector(surface.normal);
}

fn put_path(path: Path) {
    put(u32(path.depth));
    put(u32(path.ray.inward));
    put_vector(path.ray.direction);
    put_vector(path.throughput);
    put_float(path.scale);
    put_vector(path.radiance);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) invocation: vec3u) {
    let place = vec2i(invocation.xy);
    if (any(place >= settings.size)) {
        return;
    }
    let start = (place.y * settings.size.x + place.x) * WORDS;
    var rng = make_sampler(textureLoad(random, place, 0).r);
    var path = start_path(camera_ray(vec2f(settings.size), vec2f(place), &rng));
    at = start + RAY_WORD;
    put_vector(path.ray.origin);
    put_vector(path.ray.direction);
    at = start + HIT_WORD;
    put_hit(path.ray);
    var goes_on = extend_path(&path, &rng);
    at = start + SCATTERING_WORD;
    put_path(path);
    while (goes_on) {
        goes_on = extend_path(&path, &rng);
    }
    at = start + DRAWS_WORD;
    put(digest);
    put(draws);
}
