// Light that comes straight from a lamp, the sun or the background, scattered once.

// Weight of light sampled on a lamp; `scattered`: the density with which scattering would have met it.
float weight_of_sample(LightSample light, float scattered, float rho) {
    if (HAS_PARTICLES && rho > 0.0) return sample_beside_particles(light, scattered, rho);
    return power_heuristic(light.pdf, scattered);
}

// Whether the background lights this surface as if nothing hid it.
bool is_under_open_sky(Material material) {
    return CHOSEN && !has_effect(AMBIENT_OCCLUSION) && ends_paths(material);
}

// Direct light from one sampled point, scattered towards wo; `rho`: see Rivals. `is_sky`: of the background.
vec3 direct_light(Vertex vertex, LightSample light, float rho, bool is_sky) {
    if (light.pdf == 0.0 || is_dark(light)) return vec3(0.0);
    vec3 wi = to_local(vertex.frame, light.ray.direction);
    bool crosses = scatters_across(vertex.material) && wi.z < 0.0;
    if (wi.z <= 0.0 && !crosses) return vec3(0.0);
    if (is_left_out(vertex.material, crosses)) return vec3(0.0);
    bool is_open = is_sky && is_under_open_sky(vertex.material);
    if (crosses) light.ray.inward = !light.ray.inward;
    vec3 weight = eval_material(vertex, wi) / light.pdf;
    if (WEIGHT_BOTH && !is_open) {
        float scattered = pdf_material(vertex, wi);
        float share = weight_of_sample(light, scattered, rho);
        record_weight(scattered, share);
        weight *= share;
    }
    bool is_hidden = is_sky ? !is_open : has_effect(SHADOWS);
    if (!HAS_MEDIA && is_hidden && occluded(light.ray, light.distance, light.shape)) {
        record_shadow();
        return vec3(0.0);
    }
    vec3 radiance = weight * light.radiance;
    return radiance;
}

// Adds the light of a gradient that nothing hides, scattered where the path meets a surface.
void gather_open_sky(inout Path path, Vertex vertex) {
    path.asking.is_open = is_under_open_sky(vertex.material);
    if (!path.asking.is_open || !HAS_BACKGROUND || SAMPLE_SKY || is_delta(vertex.material)) return;
    if (LIGHT_TERMS != 0) sort_by_surface(path, vertex, vertex.frame[2], 1.0, false);
    vec3 light = path.scale * path.throughput * head_on_reflectance(vertex.material) * unhidden_sky(vertex.frame[2]);
    gather(path, light, BACKGROUND_LAYER, path.depth + 1);
}
