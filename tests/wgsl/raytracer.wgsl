// The compute shader: adds one sample to every pixel. Two colour textures take turns as source and
// target; beside each stands one for the variance, from which the standard error comes.

@group(1) @binding(0) var random: texture_2d<u32>;  // a seed for each pixel, new in every frame
@group(1) @binding(1) var source_mean: texture_2d<f32>;  // a: dropped samples
@group(1) @binding(2) var source_variance: texture_2d<f32>;  // a: observations
@group(1) @binding(3) var target_mean: texture_storage_2d<rgba32float, write>;
@group(1) @binding(4) var target_variance: texture_storage_2d<rgba32float, write>;

fn load_pixel(place: vec2i) -> Pixel {
    if (samples_so_far == 0) {
        return empty_pixel();  // whatever the source holds
    }
    let mean = textureLoad(source_mean, place, 0);
    let variance = textureLoad(source_variance, place, 0);
    return Pixel(mean.rgb, mean.a, variance.rgb, variance.a);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) invocation: vec3u) {
    let place = vec2i(invocation.xy);
    if (any(place >= settings.size)) {
        return;
    }
    var pixel = load_pixel(place);
    let seed = textureLoad(random, place, 0).r;
    add_sample(&pixel, trace(place, seed), samples_so_far);
    textureStore(target_mean, place, vec4f(pixel.mean, pixel.dropped));
    textureStore(target_variance, place, vec4f(pixel.variance, pixel.observations));
}
