// Lighting models older than the rendering equation: light goes straight from lamp to surface to
// eye, or over mirrors and glass. MODEL is 0 where paths are traced.
//
// Lamps are points in their centres in all models except COOK. Each has the power that its whole area
// sends in this direction. The background is an even light that nothing hides.

const int PHONG = 1;    // no shadows; highlights around the mirrored direction (Phong 1975)
const int BLINN = 2;    // the same around the half vector (Blinn 1977): the thesis's Appendix A
const int WHITTED = 3;  // shadows, mirrors and glass (Whitted 1980): Appendix B
const int COOK = 4;     // a random point of a lamp, of the lens and of a lobe (Cook et al. 1984)
const int WHITTED_TREE = 5;  // Whitted's tree: glass sends both rays, and nothing is random but the place in a pixel

const int MOST_EXPONENT = 16777216;  // 2^24

// Whether light is followed beyond this surface. Principled surfaces reflect only lamps.
//
// At glass, all models but WHITTED_TREE follow one of two rays, by a random choice. The mean is the same, work does not
// double at each surface, and antialiasing takes many samples a pixel anyway.
bool is_followed(Material material) {
    if (HAS_PRINCIPLED && material.kind == PRINCIPLED) return MODEL == 0;
    return MODEL == 0 || MODEL >= WHITTED && material.kind != MATTE;
}

// x^n by squaring: pow differs between drivers.
float whole_power(float x, int n) {
    float result = 1.0;
    float square = x;
    int rest = n;
    for (; rest > 0; rest /= 2) {
        if (rest % 2 == 1) result *= square;
        square *= square;
    }
    note_end(0, rest);
    return result;
}

// The exponent of a half vector's highlight that is as wide as the GGX lobe. A highlight around the
// mirrored direction is as wide with a quarter of this exponent, since its angle is twice as large.
int highlight_exponent(float alpha) {
    float exponent = min(2.0 / (alpha * alpha), float(MOST_EXPONENT)) - 2.0;
    return max(int(exponent), 0);
}

// The value contains the cosine. It is scaled so that a white metal seen head-on reflects everything: the
// integrals are 2 PI / (m + 2) and 8 PI (2^(-n/2) + n) / ((n + 2) (n + 4)).
float eval_highlight(float alpha, vec3 wo, vec3 wi) {
    int n = highlight_exponent(alpha);
    if (MODEL == BLINN) {
        vec3 h = normalized(wo + wi);
        float rest = whole_power(sqrt(0.5), n) + float(n);
        float scale = float(n + 2) / (2.0 * PI) * (float(n + 4) / (2.0 * 2.0 * rest));
        float value = scale * whole_power(h.z, n) * wi.z;
        return value;
    }
    int m = n / 4;
    float along = max(dot(vec3(-wo.xy, wo.z), wi), 0.0);
    float scale = float(m + 2) / (2.0 * PI);
    float value = scale * whole_power(along, m) * wi.z;
    return value;
}

vec3 eval_local(Vertex vertex, vec3 wi) {
    Material material = vertex.material;
    if (material.kind == MATTE) return eval_matte(material.color, wi);
    if (HAS_PRINCIPLED && material.kind == PRINCIPLED) return eval_principled(vertex, wi);
    if (!HAS_ROUGH_METAL || material.kind != METAL || material.alpha == 0.0) return vec3(0.0);
    vec3 value = head_on_reflectance(material) * eval_highlight(material.alpha, vertex.wo, wi);
    return value;
}
