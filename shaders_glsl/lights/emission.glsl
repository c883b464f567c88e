// What a lamp emits towards a direction.

// Of the emission within a cone, towards a unit direction: 1 - cos of the angle to its axis keeps the
// digits of narrow ones.
float share_in_cone(Emitter emitter, vec3 direction) {
    precise vec3 aside = direction - emitter.axis;
    precise float s = clamp((emitter.outer - 0.5 * dot(aside, aside)) * emitter.slope, 0.0, 1.0);
    precise float share = s * s * (3.0 - 2.0 * s);
    return share;
}

// `facing`: whether the direction leaves the front.
vec3 emitted(Material material, vec3 direction, bool facing) {
    if (!HAS_CONE && !HAS_ONE_SIDED) return material.emission;
    precise Emitter emitter = emitter_at(material.emitter);
    if (HAS_ONE_SIDED && emitter.is_one_sided != 0 && !facing) return vec3(0.0);
    if (!HAS_CONE) return material.emission;
    precise vec3 radiance = material.emission * share_in_cone(emitter, direction);
    return radiance;
}
