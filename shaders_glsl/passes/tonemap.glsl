// From radiance to the colours of a screen: exposure, tone curve, sRGB encoding.
// Colours are linear sRGB (Rec. 709 primaries). The twin of glrt/image/tonemap.py, which names the sources.

const int TONEMAP_NONE = 0;
const int TONEMAP_ACES = 1;
const int TONEMAP_AGX = 2;
const int TONEMAP_NEUTRAL = 3;

const float TONEMAP_LIMIT = 1e9; // every curve reaches its limit to 8 bits far below; squares stay finite

// The sRGB transfer function of IEC 61966-2-1, piecewise; 0..1 to 0..1.
vec3 encode_srgb(vec3 linear) {
    vec3 curved = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
    return mix(curved, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

const mat3 ACES_INPUT = mat3( // linear sRGB -> XYZ -> D60 -> AP1 -> RRT saturation; by columns
    0.59719, 0.07600, 0.02840,
    0.35458, 0.90834, 0.13383,
    0.04823, 0.01566, 0.83777);
const mat3 ACES_OUTPUT = mat3( // ODT saturation -> XYZ -> D65 -> linear sRGB; by columns
    1.60475, -0.10208, -0.00327,
    -0.53108, 1.10813, -0.07276,
    -0.07367, -0.00605, 1.07602);

// ACES RRT + sRGB ODT, as fitted by Stephen Hill.
vec3 tone_aces(vec3 color) {
    vec3 v = ACES_INPUT * color;
    vec3 fitted = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return clamp(ACES_OUTPUT * fitted, 0.0, 1.0);
}

const mat3 AGX_INSET = mat3( // by columns
    0.842479062253094, 0.0423282422610123, 0.0423756549057051,
    0.0784335999999992, 0.878468636469772, 0.0784336,
    0.0792237451477643, 0.0791661274605434, 0.879142973793104);
const mat3 AGX_OUTSET = mat3( // by columns
    1.19687900512017, -0.0528968517574562, -0.0529716355144438,
    -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
    -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
const float AGX_LOG2_MIN = -12.47393; // 10 stops below 0.18
const float AGX_LOG2_MAX = 4.026069;  // 6.5 stops above

// AgX base look, as fitted by Benjamin Wrensch: it is for a display with exponent 2.2, which is undone here.
vec3 tone_agx(vec3 color) {
    vec3 exponent = log2(max(AGX_INSET * color, vec3(exp2(AGX_LOG2_MIN))));
    vec3 x = clamp((exponent - AGX_LOG2_MIN) / (AGX_LOG2_MAX - AGX_LOG2_MIN), 0.0, 1.0);
    vec3 y = ((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191;
    return pow(clamp(AGX_OUTSET * (y * x - 0.00232), 0.0, 1.0), vec3(2.2));
}

const float NEUTRAL_F90 = 0.04; // Fresnel reflection of glass at normal incidence
const float NEUTRAL_SHOULDER = 0.76;
const float NEUTRAL_DESATURATION = 0.15;

// Khronos PBR Neutral: the identity less an offset, up to a peak; then a shoulder that fades to white.
vec3 tone_neutral(vec3 color) {
    float darkest = min(min(color.r, min(color.g, color.b)), 2.0 * NEUTRAL_F90);
    vec3 offset = vec3(darkest - darkest * darkest / (4.0 * NEUTRAL_F90));
    color = max(color - offset, 0.0);
    float peak = max(max(color.r, max(color.g, color.b)), NEUTRAL_SHOULDER);
    float room = 1.0 - NEUTRAL_SHOULDER;
    float new_peak = 1.0 - room * room / (peak - NEUTRAL_SHOULDER + room);
    float kept = 1.0 / (NEUTRAL_DESATURATION * (peak - new_peak) + 1.0);
    return color * (new_peak / peak) * kept + vec3(new_peak * (1.0 - kept));
}

// Radiance times 2^exposure_ev, through the tone curve, sRGB-encoded: 0..1, ready for 8 bits.
vec3 expose_and_encode(vec3 radiance, float exposure_ev, int tonemap) {
    vec3 color = clamp(radiance * exp2(exposure_ev), 0.0, TONEMAP_LIMIT);
    if (tonemap == TONEMAP_ACES) {
        color = tone_aces(color);
    } else if (tonemap == TONEMAP_AGX) {
        color = tone_agx(color);
    } else if (tonemap == TONEMAP_NEUTRAL) {
        color = tone_neutral(color);
    }
    return encode_srgb(clamp(color, 0.0, 1.0));
}
