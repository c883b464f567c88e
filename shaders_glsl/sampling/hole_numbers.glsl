// Numbers that decide whether light passes a surface that is there in part. They are no draws of the sampler: how
// many a path needs depends on what it meets, and rays to lamps need some of their own.

uint hole_key = 0u;  // of the sample, and of the vertex that a ray leaves

void leave_vertex(uint seed, int depth) {
    if (HAS_HOLE) hole_key = pcg_hash(seed ^ pcg_hash(uint(depth)));
}

// For the surface that a ray meets after `passed` others.
float hole_number(uint passed) {
    precise float value = unit_float(pcg_hash(hole_key + passed));
    return value;
}
