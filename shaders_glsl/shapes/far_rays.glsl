// Rays that come from afar to meshes, for example from an endless floor near the horizon. Far from a triangle, the
// rounding of a ray is greater than the triangle. So its start is moved along the ray, nearer to the tree.

const float HALF_GRID = 8388608.0;  // cells from the middle of the grid of the tree to its sides
const float FAR_FROM = 8.0;  // in radii of a ball around the grid: nearer rays begin where they begin
const uint FIRST_BITS = 0xFFFFF000u;  // of a float: 12 binary digits; a product of two such floats is exact

// Where a ray begins among triangles.
struct Start {
    vec3 place;     // relative to the middle of the tree
    float skipped;  // distance from the origin of the ray to there
    float largest;  // the rounding of the place is relative to it
};

vec3 first_digits(vec3 v) {
    return uintBitsToFloat(floatBitsToUint(v) & FIRST_BITS);
}

// The place has the rounding of its own size: all terms of its sum are exact, and the largest cancel first.
Start start_of(Ray ray) {
    vec3 center = frame.tree_center;
    vec3 place = ray.origin - center;
    vec3 size = max(abs(ray.origin), abs(center));
    float largest = larger(larger(size.x, size.y), size.z);
    if (HAS_TREE || !HAS_MESH) return Start(place, 0.0, largest);  // other shapes are tested from the origin of the ray
    float reach = 2.0 * HALF_GRID * frame.tree_cell;  // its corners lie at 1.74 HALF_GRID
    float along = -dot(place, ray.direction);
    if (!(along > FAR_FROM * reach)) return Start(place, 0.0, largest);
    float way = along - reach;
    float skipped = uintBitsToFloat(floatBitsToUint(way) & FIRST_BITS);
    vec3 back = place - ray.origin;
    vec3 lost = (ray.origin - (place - back)) - (center + back);  // by the rounding of `place` (Knuth's sum of two)
    vec3 coarse = first_digits(ray.direction);
    vec3 fine = ray.direction - coarse;
    vec3 near = (place + skipped * coarse) + skipped * fine;
    near += lost;
    vec3 left = abs(near);
    return Start(near, skipped, larger(larger(left.x, left.y), larger(left.z, reach)));
}
