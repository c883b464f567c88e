// Scientific volumes: a transfer function gives the density at a place its colour and its opacity, after the density is
// interpolated (post-classification; Levoy, "Display of Surfaces from Volume Data", 1988). Nothing scatters there.
//
// A function is a list of knots. Drivers grant kernels no more textures, so knots lie in the array of media, in the rows
// after that of their medium: glrt/packing/media.py.

const float CLASSIFIED = 2.0;  // in place of the anisotropy of a medium with a transfer function

struct Knot {
    float value;
    float opacity;
    vec3 color;
};

Knot knot_at(int medium, int number) {
    Medium row = medium_at(medium + 1 + number);
    return Knot(row.emission.x, row.emission.y, row.scattering);
}

bool is_classified(int medium) {
    return medium != NO_MEDIUM && medium_at(medium).anisotropy == CLASSIFIED;
}

int knots_of(Medium medium) {
    return int(medium.extinction.x);
}

// The extinction of an opacity below 1 over this length: -ln(1 - opacity) / length. The series of artanh keeps the
// digits of small opacities, and is right to 2e-8.
float extinction_of(float opacity, float way) {
    float s = opacity / (2.0 - opacity);
    float s2 = s * s;
    float p = s2 * (1.0 / 7.0) + 1.0 / 5.0;
    p = p * s2 + 1.0 / 3.0;
    float series = 2.0 * s + 2.0 * s * s2 * p;
    float extinction = (opacity < 0.25 ? series : depth_of(opacity)) / way;
    return extinction;
}

// The knot that this density has, or the mean of the two around it.
Knot classify(int medium, int knots, float density) {
    Knot before = knot_at(medium, 0);
    Knot after = before;
    for (int i = 1; i < knots; ++i) {
        after = knot_at(medium, i);
        if (after.value > density) break;
        before = after;
    }
    if (density <= before.value || after.value <= density) return before;
    float share = (density - before.value) / (after.value - before.value);
    before.opacity += share * (after.opacity - before.opacity);
    before.color += share * (after.color - before.color);
    return before;
}

// The least and the largest density in the brick, over that of a voxel with the value 1.
vec2 bounds_of_brick(Medium grid, ivec3 brick) {
    ivec3 count = (grid.size - 1) / int(BRICK) + 1;
    int first = grid.first + grid.size.x * grid.size.y * grid.size.z;
    vec2 bounds = voxel_at(first + (brick.z * count.y + brick.y) * count.x + brick.x).yx;
    return bounds;
}

// The extinction that no place in the brick exceeds. A density between voxels may be off by rounding.
float most_in_brick(int row, Medium medium, ivec3 brick) {
    vec2 ends = clamp(bounds_of_brick(medium, brick) + vec2(-1e-6, 1e-6), 0.0, 1.0) * medium.top;
    int knots = knots_of(medium);
    float opacity = max(classify(row, knots, ends.x).opacity, classify(row, knots, ends.y).opacity);
    for (int i = 0; i < knots; ++i) {
        Knot knot = knot_at(row, i);
        if (knot.value >= ends.x && knot.value <= ends.y) opacity = max(opacity, knot.opacity);
    }
    float most = extinction_of(opacity, medium.extinction.y);
    return most;
}

// Like `cross_grid`, for a medium with a transfer function.
GridShare cross_classified(int row, Ray ray, float distance) {
    Medium medium = medium_at(row);
    vec3 boxes = vec3(length(medium.x), length(medium.y), length(medium.z)) / vec3(medium.size);
    float least = LEAST_COLLISIONS * max(max(boxes.x, boxes.y), boxes.z);
    GridShare found = GridShare(vec3(1.0), vec3(0.0));
    March march = enter_grid(medium, ray, distance);
    float depth = depth_of(next_of_collision());
    while (march.way < march.end) {
        float most = most_in_brick(row, medium, march.brick);
        float rate = most > 0.0 ? max(most, least) : 0.0;
        float room = rate * (march.stop - march.way);
        if (depth >= room) {
            depth -= room;
            leave_brick(march, medium);
            continue;
        }
        march.way += depth / rate;
        float density = density_at(medium, march.start + march.way * march.along);
        Knot seen = classify(row, knots_of(medium), density);
        float part = min(extinction_of(seen.opacity, medium.extinction.y) / rate, 1.0);
        found.glow += found.share * part * seen.color;
        found.share *= 1.0 - part;
        if (found.share == vec3(0.0)) return found;
        depth = depth_of(next_of_collision());
    }
    note_end(march.way < march.end ? 0 : 1, 1);
    return found;
}
