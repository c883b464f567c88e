// The display shader: a quad over the whole screen shows the target of the last frame, exposed,
// tone-mapped, sRGB. The twin of shaders_glsl/display.vert and display.frag.

struct Look {
    exposure: f32,  // EV
    tonemap: i32,
}

@group(0) @binding(0) var<uniform> look: Look;
@group(0) @binding(1) var picture: texture_2d<f32>;

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) place: vec2f,  // (0, 0) in the upper left corner of the picture
}

@vertex
fn at_corner(@builtin(vertex_index) index: u32) -> Corner {
    let corner = vec2f(vec2u(index & 1u, index >> 1u));
    return Corner(vec4f(2.0 * corner - 1.0, 0.0, 1.0), vec2f(corner.x, 1.0 - corner.y));
}

@fragment
fn color_at(corner: Corner) -> @location(0) vec4f {
    let size = vec2f(textureDimensions(picture));
    let texel = min(vec2i(corner.place * size), vec2i(size) - 1);
    let radiance = textureLoad(picture, texel, 0).rgb;
    return vec4f(expose_and_encode(radiance, look.exposure, look.tonemap), 1.0);
}
