// Records the stages of one sample of each pixel. The path text and the size of a work group
// stand in front: see tests/wgsl/stages.py. The twin of stages.wgsl.

layout(std430) writeonly buffer Words { uint words[]; };

int at;

void put(uint word) {
    words[at] = word;
    at += 1;
}

void put_float(float x) {
    put(floatBitsToUint(x));
}

void put_vector(vec3 v) {
    put_float(v.x);
    put_float(v.y);
    put_float(v.z);
}

void put_hit(Ray ray) {
    Hit hit = closest_hit(ray);
    put(uint(hit.shape));
    put_float(hit.distance);
    if (hit.shape == NO_SHAPE) return;
    Surface surface = surface_at(ray, hit);
    put(uint(surface.material));
    put_vector(surface.position);
    put_vector(surface.normal);
}

void put_path(Path path) {
    put(uint(path.depth));
    put(uint(path.ray.inward));
    put_vector(path.ray.direction);
    put_vector(path.throughput);
    put_float(path.scale);
    put_vector(path.radiance);
}

void main() {
    int pixel = int(gl_GlobalInvocationID.x);
    int start = pixel * WORDS;
    if (pixel >= frame.size.x * frame.size.y) return;
    ivec2 place = ivec2(pixel % frame.size.x, pixel / frame.size.x);
    Sampler rng = sampler_at(place, frame.first_sample, frame.seed);
    Path path = camera_path(place, rng);
    at = start + RAY_WORD;
    put_vector(path.ray.origin);
    put_vector(path.ray.direction);
    at = start + HIT_WORD;
    put_hit(path.ray);
    bool goes_on = extend_path(path, rng);
    at = start + SCATTERING_WORD;
    put_path(path);
    while (goes_on) goes_on = extend_path(path, rng);
    at = start + DRAWS_WORD;
    put(digest);
    put(draws);
}
