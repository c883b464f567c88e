// A ray against the boxes of the children of a node. A box only says which shapes may be left out. It is
// wider than the rounding of any test of a shape. So the tree gives the same hits as the loop over all
// shapes, bit for bit.

// Assumed error of the origin of a ray, relative to the largest coordinate of the origin, of the tree's middle
// or of its grid: 16 times the rounding of a float. Wider boxes let rays from afar meet triangles that they see from
// the edge, whose distance is rounding, and make them slow.
const float SLACK = 9.5367431640625e-7;
const float INSTANCE_SLACK = 7.62939453125e-6;  // 128 times: rays of instances are placed in their coordinates first
const float STEEPEST = 1.2379400392853803e27;  // 2^90: nothing in the tests of boxes overflows
const uint NO_CHILD = 0xFFFFFFFFu;

// A ray among the cells of the grid.
struct TreeRay {
    vec3 before;   // the origin, moved by its slack so that the ray enters boxes sooner
    vec3 behind;   // the same, so that the ray leaves boxes later
    vec3 inverse;  // of the direction, at most STEEPEST
    bvec3 is_down;
};

// `start` is relative to the middle of the grid, in cells; the rounding of its coordinates is relative to `largest`,
// by the share `error`.
TreeRay ray_on_grid(vec3 start, float largest, float error, vec3 direction, float cell) {
    vec3 place = start + HALF_GRID;
    float slack = error * larger(largest, 2.0 * HALF_GRID);
    vec3 inverse = clamp(cell / direction, vec3(-STEEPEST), vec3(STEEPEST));
    bvec3 is_down = lessThan(inverse, vec3(0.0));  // also right for zeros of both signs
    vec3 shift = vec3(is_down.x ? -slack : slack, is_down.y ? -slack : slack, is_down.z ? -slack : slack);
    return TreeRay(place + shift, place - shift, inverse, is_down);
}

TreeRay tree_ray(Start start, vec3 direction) {
    float cells = 1.0 / frame.tree_cell;
    float largest = start.largest * cells;
    return ray_on_grid(start.place * cells, largest, SLACK, direction, frame.tree_cell);
}

// The children of a node as a ray meets them: for all 8, one byte each along each axis.
struct Children {
    vec3 cell;        // edge of a cell over the direction
    vec3 enter_from;  // distance to the start of the first cell, with the slack of entering
    vec3 leave_from;
    uvec3 near_low;   // planes where the ray enters the boxes of the first four
    uvec3 near_high;  // planes where it enters those of the others
    uvec3 far_low;
    uvec3 far_high;
    uint last;
};

Children children_of(Slot slot, TreeRay ray) {
    vec3 corner = vec3(ivec3(slot.a.xyz & 0xFFFFFFu));
    vec3 cell = uintBitsToFloat(slot.a.xyz >> 24u << 23u);
    uvec3 start_low = uvec3(slot.a.w, slot.b.w, slot.c.w);
    uvec3 start_high = uvec3(slot.b.x, slot.c.x, slot.d.x);
    uvec3 end_low = uvec3(slot.b.y, slot.c.y, slot.d.y);
    uvec3 end_high = uvec3(slot.b.z, slot.c.z, slot.d.z);
    bvec3 down = ray.is_down;
    return Children(
        cell * ray.inverse, (corner - ray.before) * ray.inverse, (corner - ray.behind) * ray.inverse,
        uvec3(down.x ? end_low.x : start_low.x, down.y ? end_low.y : start_low.y,
              down.z ? end_low.z : start_low.z),
        uvec3(down.x ? end_high.x : start_high.x, down.y ? end_high.y : start_high.y,
              down.z ? end_high.z : start_high.z),
        uvec3(down.x ? start_low.x : end_low.x, down.y ? start_low.y : end_low.y,
              down.z ? start_low.z : end_low.z),
        uvec3(down.x ? start_high.x : end_high.x, down.y ? start_high.y : end_high.y,
              down.z ? start_high.z : end_high.z),
        slot.d.w >> 27u & 7u);
}

// Where the ray enters the box of a child before `limit`. The result is the bits of the distance, whose order is that
// of the distances, with the number of the child in the last three; else NO_CHILD.
uint meets_child(Children children, uint number, uvec3 near, uvec3 far, float limit) {
    uint shift = 8u * (number & 3u);
    vec3 start = vec3(ivec3(near >> shift & 255u)) * children.cell + children.enter_from;
    vec3 end = vec3(ivec3(far >> shift & 255u)) * children.cell + children.leave_from;
    float enters = larger(larger(start.x, start.y), larger(start.z, 0.0));
    float leaves = lesser(lesser(end.x, end.y), lesser(end.z, limit));
    bool is_met = enters <= leaves && number <= children.last;
    return is_met ? floatBitsToUint(enters) & ~7u | number : NO_CHILD;
}
