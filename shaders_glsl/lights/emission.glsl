// Emission of a lamp towards a direction. A cone limits the directions. It leaves a share of the emission that
// falls with v = 1 - cos of the angle to the axis; v keeps the digits of small angles.

const bool IS_AIMED = HAS_CONE || HAS_ONE_SIDED;  // whether some lamp cannot be seen from everywhere

// Falls from 1 to 0, and is 0 from `outer` on; `slope`: 1 over the length of v over which it falls.
float share_in_cone(float versine, float outer, float slope) {
    float s = clamp((outer - versine) * slope, 0.0, 1.0);
    float share = s * s * (3.0 - 2.0 * s);
    return share;
}

// Radiance towards a unit direction; `facing`: whether the direction leaves the front.
vec3 emitted(Material material, vec3 direction, bool facing) {
    if (!IS_AIMED) return material.emission;
    Emitter emitter = emitter_at(material.emitter);
    if (HAS_ONE_SIDED && emitter.is_one_sided != 0 && !facing) return vec3(0.0);
    if (!HAS_CONE) return material.emission;
    vec3 aside = direction - emitter.axis;
    float share = share_in_cone(0.5 * dot(aside, aside), emitter.outer, emitter.slope);
    vec3 radiance = material.emission * share;
    return radiance;
}

// The largest share of emission that lamps within `reach` of a place send to the point at `away` from it. It is 0
// only where no lamp sends any. A lamp at the edge of that ball emits towards the point under another angle.
const float ROUNDING_OF_VERSINES = 9.5367431640625e-7;  // 2^-20, of 1 - cos by differences

float share_towards(Aim aim, vec3 away) {
    float distance = length(away);
    if (distance <= aim.reach) return 1.0;
    float cosine = dot(away, aim.axis) / distance;
    float sine = sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0));
    float lamp_sine = aim.reach / distance;
    float lamp_cosine = sqrt((1.0 - lamp_sine) * (1.0 + lamp_sine));
    float nearest = cosine >= lamp_cosine ? 1.0 : cosine * lamp_cosine + sine * lamp_sine;
    float versine = 1.0 - nearest - ROUNDING_OF_VERSINES;
    return share_in_cone(versine, aim.outer, aim.slope);
}
