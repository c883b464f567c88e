// From radiance to the colours of a screen: exposure, tone curve, sRGB encoding.
// The twin of shaders_glsl/passes/tonemap.glsl.

const TONEMAP_ACES: i32 = 1;
const TONEMAP_AGX: i32 = 2;
const TONEMAP_NEUTRAL: i32 = 3;

const TONEMAP_LIMIT: f32 = 1e9;

// The sRGB transfer function of IEC 61966-2-1, piecewise; 0..1 to 0..1.
fn encode_srgb(linear_: vec3f) -> vec3f {
    let curved = 1.055 * pow(linear_, vec3f(1.0 / 2.4)) - 0.055;
    return select(curved, 12.92 * linear_, linear_ <= vec3f(0.0031308));
}

const ACES_INPUT = mat3x3f(  // by columns
    0.59719, 0.07600, 0.02840,
    0.35458, 0.90834, 0.13383,
    0.04823, 0.01566, 0.83777);
const ACES_OUTPUT = mat3x3f(  // by columns
    1.60475, -0.10208, -0.00327,
    -0.53108, 1.10813, -0.07276,
    -0.07367, -0.00605, 1.07602);

// ACES RRT + sRGB ODT, as fitted by Stephen Hill.
fn tone_aces(color: vec3f) -> vec3f {
    let v = ACES_INPUT * color;
    let fitted = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return clamp(ACES_OUTPUT * fitted, vec3f(0.0), vec3f(1.0));
}

const AGX_INSET = mat3x3f(  // by columns
    0.842479062253094, 0.0423282422610123, 0.0423756549057051,
    0.0784335999999992, 0.878468636469772, 0.0784336,
    0.0792237451477643, 0.0791661274605434, 0.879142973793104);
const AGX_OUTSET = mat3x3f(  // by columns
    1.19687900512017, -0.0528968517574562, -0.0529716355144438,
    -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
    -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
const AGX_LOG2_MIN: f32 = -12.47393;  // 10 stops below 0.18
const AGX_LOG2_MAX: f32 = 4.026069;   // 6.5 stops above

// AgX base look, as fitted by Benjamin Wrensch: for a display with exponent 2.2, here undone.
fn tone_agx(color: vec3f) -> vec3f {
    let exponent = log2(max(AGX_INSET * color, vec3f(exp2(AGX_LOG2_MIN))));
    let span = AGX_LOG2_MAX - AGX_LOG2_MIN;
    let x = clamp((exponent - AGX_LOG2_MIN) / span, vec3f(0.0), vec3f(1.0));
    let y = ((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191;
    return pow(clamp(AGX_OUTSET * (y * x - 0.00232), vec3f(0.0), vec3f(1.0)), vec3f(2.2));
}

const NEUTRAL_F90: f32 = 0.04;  // Fresnel reflection of glass at normal incidence
const NEUTRAL_SHOULDER: f32 = 0.76;
const NEUTRAL_DESATURATION: f32 = 0.15;

// Khronos PBR Neutral: the identity less an offset, up to a peak; then a shoulder that fades to white.
fn tone_neutral(radiance: vec3f) -> vec3f {
    let darkest = min(min(radiance.r, min(radiance.g, radiance.b)), 2.0 * NEUTRAL_F90);
    let offset = vec3f(darkest - darkest * darkest / (4.0 * NEUTRAL_F90));
    let color = max(radiance - offset, vec3f(0.0));
    let peak = max(max(color.r, max(color.g, color.b)), NEUTRAL_SHOULDER);
    let room = 1.0 - NEUTRAL_SHOULDER;
    let new_peak = 1.0 - room * room / (peak - NEUTRAL_SHOULDER + room);
    let kept = 1.0 / (NEUTRAL_DESATURATION * (peak - new_peak) + 1.0);
    return color * (new_peak / peak) * kept + vec3f(new_peak * (1.0 - kept));
}

// Radiance times 2^exposure_ev, through the tone curve, sRGB-encoded: 0..1, ready for 8 bits.
fn expose_and_encode(radiance: vec3f, exposure_ev: f32, tonemap: i32) -> vec3f {
    var color = clamp(radiance * exp2(exposure_ev), vec3f(0.0), vec3f(TONEMAP_LIMIT));
    if (tonemap == TONEMAP_ACES) {
        color = tone_aces(color);
    } else if (tonemap == TONEMAP_AGX) {
        color = tone_agx(color);
    } else if (tonemap == TONEMAP_NEUTRAL) {
        color = tone_neutral(color);
    }
    return encode_srgb(clamp(color, vec3f(0.0), vec3f(1.0)));
}
