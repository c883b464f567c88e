// Normals for shading that are not those of the surface: meshes interpolate theirs, and images have some. They break
// the symmetry of light paths. A path from the camera that comes from wo scatters around a normal n, and takes light
// from wi by its cosine; but how much flux arrives, and how much of it the film sees, goes by the true normal g. So
// what follows flux carries, beside the BSDF (Veach 1997, section 5.3),
//     (wi . n / wi . g) (wo . g / wo . n)
// of which a matte surface has the first ratio alone where particles leave it by the cosine to g. It is P0 over PL
// there as well (integrators/particle_weights.glsl).

const bool HAS_SHADING = HAS_SMOOTH || HAS_NORMAL_MAP;

// Of a surface, unit, on one side of it.
struct Normals {
    vec3 facing;   // the true one
    vec3 shading;
};

// Whether a path in this direction scatters around the true normal: where the other one faces away from where it
// comes from, or would reflect it through the surface. Both are on that side.
bool scatters_flat(vec3 facing, vec3 normal, vec3 direction) {
    precise float along = dot(normal, direction);
    precise vec3 reflected = direction - 2.0 * along * normal;
    return along >= 0.0 || dot(reflected, facing) <= 0.0;
}

// Around the normal that a path in this direction scatters around, on the side that it comes from.
mat3 shading_frame(vec3 facing, vec3 normal, vec3 direction) {
    if (HAS_SHADING && scatters_flat(facing, normal, direction)) return frame_around(facing);
    return frame_around(normal);
}

// As scatters_flat, of a path from the camera that comes from wo, on either side.
bool is_flat_towards(Normals at, vec3 wo) {
    precise float side = dot(wo, at.facing) < 0.0 ? -1.0 : 1.0;
    return scatters_flat(side * at.facing, side * at.shading, -wo);
}

// P0 over PL of scattering around `normal`, which is on the side of `facing`, between wi, where light comes from, and
// wo; what a particle carries, too. 0 where no path from the camera goes so.
float turn_around(vec3 normal, vec3 facing, vec3 wi, vec3 wo, bool is_smooth) {
    if (!HAS_SHADING) return 1.0;
    precise float turn = dot(wi, normal) / dot(wi, facing);
    if (is_smooth) turn *= dot(wo, facing) / dot(wo, normal);
    return turn > 0.0 && turn < FAR ? turn : 0.0;
}

// The same, around the normal that a path from the camera scatters around which comes from wo.
float turn_towards(Normals at, vec3 wi, vec3 wo, bool is_smooth) {
    if (!HAS_SHADING || is_flat_towards(at, wo)) return 1.0;
    return turn_around(at.shading, at.facing, wi, wo, is_smooth);
}
