// One unit of the sums of what particles add to pixels.

const float COUNT_UNIT = 9.5367431640625e-7;  // 2^-20: counts of rays have nothing to do with how bright lamps are

float splat_unit() {
    return COUNT_RAYS ? COUNT_UNIT : frame.splat_unit;
}
