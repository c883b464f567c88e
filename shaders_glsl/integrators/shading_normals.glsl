// Normals for shading differ from the true normal of the surface: meshes interpolate theirs, and images contain some.
// They break the symmetry of light paths. A path from the camera that comes from wo scatters around a normal n, and
// takes light from wi by its cosine to n. But the true normal g decides how much flux arrives, and how much of it the
// film sees. So flux that is followed carries a factor in addition to the BSDF (Veach 1997, section 5.3),
//     (wi . n / wi . g) (wo . g / wo . n)
// A matte surface has the first ratio alone where particles leave it by the cosine to g. The factor is also P0 over PL
// there (integrators/particle_weights.glsl).

const bool HAS_SHADING = HAS_SMOOTH || HAS_NORMAL_MAP;

// Normals of a surface, unit, both on one side of it.
struct Normals {
    vec3 facing;   // the true one
    vec3 shading;
};

// Whether a path in this direction scatters around the true normal. It does where the normal for shading faces away
// from where the path comes from, or would reflect the path through the surface. Both normals are on that side.
bool scatters_flat(vec3 facing, vec3 normal, vec3 direction) {
    float along = dot(normal, direction);
    vec3 reflected = direction - 2.0 * along * normal;
    return along >= 0.0 || dot(reflected, facing) <= 0.0;
}

// Frame around the normal that a path in this direction scatters around, on the side that it comes from.
mat3 shading_frame(vec3 facing, vec3 normal, vec3 direction) {
    if (HAS_SHADING && scatters_flat(facing, normal, direction)) return frame_around(facing);
    return frame_around(normal);
}

// scatters_flat of a path from the camera that comes from wo, on either side.
bool is_flat_towards(Normals at, vec3 wo) {
    float side = dot(wo, at.facing) < 0.0 ? -1.0 : 1.0;
    return scatters_flat(side * at.facing, side * at.shading, -wo);
}

// P0 over PL of scattering around `normal` between wi, where light comes from, and wo. It is also the factor of a
// particle's flux. `normal` is on the side of `facing`. The result is 0 where no path from the camera takes this way.
float turn_around(vec3 normal, vec3 facing, vec3 wi, vec3 wo, bool is_smooth) {
    if (!HAS_SHADING) return 1.0;
    float turn = dot(wi, normal) / dot(wi, facing);
    if (is_smooth) turn *= dot(wo, facing) / dot(wo, normal);
    return turn > 0.0 && turn < FAR ? turn : 0.0;
}

// The same, around the normal that a path from the camera scatters around if it comes from wo.
float turn_towards(Normals at, vec3 wi, vec3 wo, bool is_smooth) {
    if (!HAS_SHADING || is_flat_towards(at, wo)) return 1.0;
    return turn_around(at.shading, at.facing, wi, wo, is_smooth);
}
