// How surfaces scatter. The twin of shaders_glsl/bsdfs/material.glsl, whose legend holds here too: wo is
// unit, towards where the path came from; in local frames n is +z.

struct Vertex {
    frame: mat3x3f,  // world from local
    wo: vec3f,       // local, z > 0
    material: Material,
}

struct Scattering {
    direction: vec3f,  // world
    weight: vec3f,     // eval / pdf; 0: absorbed
    scale: f32,        // of radiance, by refraction: (eta)^2
    crosses: bool,     // through the surface
}

// 1 + Lambda, times 2 w.z: finite at grazing angles.
fn ggx_shadow(alpha: f32, w: vec3f) -> f32 {
    return w.z + sqrt(exact(w.z * w.z) + exact(alpha * alpha * dot2(w.xy, w.xy)));
}

// G2 / G1(wo) (Heitz, JCGT 2014, eq. 99).
fn ggx_weight(alpha: f32, wo: vec3f, wi: vec3f) -> f32 {
    let so = exact(ggx_shadow(alpha, wo) * wi.z);
    let si = exact(ggx_shadow(alpha, wi) * wo.z);
    let both = exact(so + si) - exact(2.0 * wo.z * wi.z);
    return so / both;
}

// A visible normal (Dupuy and Benyoub, 2023).
fn sample_ggx_normal(alpha: f32, wo: vec3f, u: vec2f) -> vec3f {
    let w = normalized(vec3f(alpha * wo.xy, wo.z));
    let phi = 2.0 * PI * u.x;
    let z = exact(exact((1.0 - u.y) * (1.0 + w.z)) - w.z);
    let r = sqrt(max((1.0 - z) * (1.0 + z), 0.0));
    let h = vec3f(exact(r * cos(phi)), exact(r * sin(phi)), z) + w;
    return normalized(vec3f(alpha * h.xy, max(h.z, 0.0)));
}

// The squared cosine on the far side; not above 0 where all light is reflected.
fn refracted_cos2(cos_i: f32, eta: f32) -> f32 {
    return exact((1.0 - eta) * (1.0 + eta)) + exact(eta * eta * (cos_i * cos_i));
}

// Unpolarised Fresnel reflectance.
fn fresnel(cos_i: f32, eta: f32) -> f32 {
    let cos2_t = refracted_cos2(cos_i, eta);
    if (cos2_t <= 0.0) {
        return 1.0;
    }
    let cos_t = sqrt(cos2_t);
    let here = exact(eta * cos_i);
    let there = exact(eta * cos_t);
    let rs = (here - cos_t) / (here + cos_t);
    let rp = (cos_i - there) / (cos_i + there);
    return 0.5 * (exact(rs * rs) + exact(rp * rp));
}

fn absorbed() -> Scattering {
    return Scattering(vec3f(0.0), vec3f(0.0), 1.0, false);
}

fn sample_matte(vertex: Vertex, u: vec2f) -> Scattering {
    let wi = sample_cosine_hemisphere(u);
    let direction = normalized(to_world(vertex.frame, wi));
    return Scattering(direction, vertex.material.color, 1.0, false);
}

fn sample_metal(vertex: Vertex, u: vec2f) -> Scattering {
    let alpha = vertex.material.alpha;
    let mirror = alpha == 0.0;
    var h = vec3f(0.0, 0.0, 1.0);
    if (!mirror) {
        h = sample_ggx_normal(alpha, vertex.wo, u);
    }
    let wi = exact3(2.0 * dot3(vertex.wo, h) * h) - vertex.wo;
    if (wi.z <= 0.0) {
        return absorbed();
    }
    let direction = normalized(to_world(vertex.frame, wi));
    if (mirror) {
        return Scattering(direction, vertex.material.color, 1.0, false);
    }
    let weight = ggx_weight(alpha, vertex.wo, wi);
    return Scattering(direction, vertex.material.color * weight, 1.0, false);
}

// One of the two directions, with the probability of its share: the weight is 1. Radiance that
// crosses is squeezed into another solid angle and scales by eta^2.
fn sample_dielectric(vertex: Vertex, eta: f32, u: f32) -> Scattering {
    let cos_i = vertex.wo.z;
    let n = vertex.frame[2];
    let incoming = -to_world(vertex.frame, vertex.wo);
    if (u < fresnel(cos_i, eta)) {
        let direction = normalized(incoming + exact3(2.0 * cos_i * n));
        return Scattering(direction, vec3f(1.0), 1.0, false);
    }
    let cos_t = sqrt(max(refracted_cos2(cos_i, eta), 0.0));
    let along_n = exact3((exact(eta * cos_i) - cos_t) * n);
    let direction = normalized(exact3(eta * incoming) + along_n);
    return Scattering(direction, vec3f(1.0), eta * eta, true);
}

// `outside`: whether wo is on the outer side of the surface.
fn sample_material(vertex: Vertex, outside: bool, rng: ptr<function, Sampler>) -> Scattering {
    let material = vertex.material;
    if (material.kind == DIELECTRIC) {
        let eta = select(material.ior, 1.0 / material.ior, outside);
        let u = next_1d(rng);
        return sample_dielectric(vertex, eta, u);
    }
    let u = next_2d(rng);
    if (material.kind == METAL) {
        return sample_metal(vertex, u);
    }
    return sample_matte(vertex, u);
}
