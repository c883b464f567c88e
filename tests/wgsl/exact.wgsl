// Arithmetic that is the same on every driver. WGSL has no `precise`: a compiler may fuse a product
// with the sum it feeds, and reorder both. It cannot look through these bits.

fn exact(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) ^ settings.zero);
}

fn exact3(v: vec3f) -> vec3f {
    return vec3f(exact(v.x), exact(v.y), exact(v.z));
}

fn dot2(a: vec2f, b: vec2f) -> f32 {
    return exact(a.x * b.x) + exact(a.y * b.y);
}

fn dot3(a: vec3f, b: vec3f) -> f32 {
    return exact(a.x * b.x) + exact(exact(a.y * b.y) + exact(a.z * b.z));
}
