// From the unit square to disks and hemispheres, and local frames to stand them in.
// The twin of shaders_glsl/sampling/warp.glsl.

const PI: f32 = 3.14159265358979324;

fn normalized(v: vec3f) -> vec3f {
    return v / sqrt(dot3(v, v));
}

// Uniform on the unit disk.
fn sample_disk(u: vec2f) -> vec2f {
    let r = sqrt(u.x);
    let phi = 2.0 * PI * u.y;
    return r * vec2f(cos(phi), sin(phi));
}

// Density cos / PI around +z.
fn sample_cosine_hemisphere(u: vec2f) -> vec3f {
    let disk = sample_disk(u);
    let z = sqrt(1.0 - u.x);
    return vec3f(disk, z);
}

// An orthonormal frame whose third column is n (Duff et al., JCGT 2017): world = frame * local.
fn frame_around(n: vec3f) -> mat3x3f {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    let x = vec3f(1.0 + exact(s * n.x * n.x * a), s * b, -s * n.x);
    let y = vec3f(b, s + exact(n.y * n.y * a), -n.y);
    return mat3x3f(x, y, n);
}

fn to_local(frame: mat3x3f, v: vec3f) -> vec3f {
    return vec3f(dot3(frame[0], v), dot3(frame[1], v), dot3(frame[2], v));
}

fn to_world(frame: mat3x3f, v: vec3f) -> vec3f {
    return exact3(exact3(frame[0] * v.x) + exact3(frame[1] * v.y)) + exact3(frame[2] * v.z);
}
