// One unit of the sums that particles add to pixels.

const float COUNT_UNIT = 9.5367431640625e-7;  // 2^-20: counts of rays do not depend on the brightness of lamps

float splat_unit() {
    return COUNT_RAYS ? COUNT_UNIT : frame.splat_unit;
}
