// Random numbers that decide whether light passes a surface that is partly there. They are not draws of the sampler: a
// path needs as many as the surfaces that it meets, and rays to lamps need some of their own.

uint hole_key = 0u;  // key of the sample, and of the vertex that a ray leaves

void leave_vertex(uint seed, int depth) {
    if (HAS_HOLE) hole_key = pcg_hash(seed ^ pcg_hash(uint(depth)));
}

// Another key, for a ray to a lamp on the way of a segment; returns the key of the segment.
uint leave_for_a_ray() {
    uint own = hole_key;
    if (HAS_HOLE) hole_key = pcg_hash(~own);
    return own;
}

// The number for the surface that a ray meets after `passed` others.
float hole_number(uint passed) {
    float value = unit_float(pcg_hash(hole_key + passed));
    return value;
}
