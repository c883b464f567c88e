// Media whose density varies: a grid of voxels, whose values are interpolated between their middles. Bricks of voxels
// have bounds of their density, so that empty space costs a step for each brick.
//
// Where light collides is found by delta tracking (Woodcock et al., 1965), and the share that comes through by ratio
// tracking (Novák et al., "Residual Ratio Tracking for Estimating Attenuation in Participating Media", SIGGRAPH Asia
// 2014): a fictitious medium fills each brick evenly up to its bound, and some collisions are null. The weights of
// channels are those of Miller et al. ("A Null-Scattering Path Integral Formulation of Light Transport", SIGGRAPH
// 2019, section 5.2).

const float BRICK = 8.0;  // voxels along an edge of a brick: glrt/scene/files/named_grids.py

const float LEAST_COLLISIONS = 4.0;
const float NEARLY_ACROSS = 1e-20;  // along an axis, in place of 0, by which a length is divided

// -ln(1 - u), for u below 1, which differs between drivers: by the exponent and the series of artanh, whose argument
// is at most 0.172. The series is right to 1e-9.
float depth_of(float u) {
    int bits = floatBitsToInt(1.0 - u);
    int exponent = (bits - 0x3F3504F3) >> 23;  // of a mantissa from sqrt(1/2) to sqrt(2)
    float mantissa = intBitsToFloat(bits - (exponent << 23));
    float s = (mantissa - 1.0) / (mantissa + 1.0);
    float s2 = s * s;
    float p = 1.0 / 9.0;
    p = p * s2 + 1.0 / 7.0;
    p = p * s2 + 1.0 / 5.0;
    p = p * s2 + 1.0 / 3.0;
    float series = 2.0 * s + 2.0 * s * s2 * p;
    float depth = -float(exponent) * 0.69314718 - series;
    return depth;
}

// A ray on its way through the bricks of a grid.
struct March {
    vec3 start;   // voxels
    vec3 along;   // voxels per unit of length
    ivec3 brick;
    float way;    // length so far
    float stop;   // length at the end of the brick, or of the march
    float end;
};

// The length at which the ray leaves its brick, and the axis along which it does.
float end_of_brick(March self, out int axis) {
    vec3 beyond = BRICK * (vec3(self.brick) + vec3(greaterThan(self.along, vec3(0.0))));
    vec3 ends = (beyond - self.start) / self.along;
    axis = ends.x <= ends.y && ends.x <= ends.z ? 0 : ends.y <= ends.z ? 1 : 2;
    float end = ends[axis];
    return end;
}

// Enters the grid's box; where the ray misses it, the march is at its end.
March enter_grid(Medium grid, Ray ray, float limit) {
    March self;
    self.start = vec3(dot(grid.x, ray.origin) + grid.at_x, dot(grid.y, ray.origin) + grid.at_y,
                      dot(grid.z, ray.origin) + grid.at_z);
    self.along = vec3(dot(grid.x, ray.direction), dot(grid.y, ray.direction), dot(grid.z, ray.direction));
    if (self.along.x == 0.0) self.along.x = NEARLY_ACROSS;
    if (self.along.y == 0.0) self.along.y = NEARLY_ACROSS;
    if (self.along.z == 0.0) self.along.z = NEARLY_ACROSS;
    vec3 first = -self.start / self.along;
    vec3 second = (vec3(grid.size) - self.start) / self.along;
    vec3 low = min(first, second);
    vec3 high = max(first, second);
    self.way = max(max(low.x, low.y), max(low.z, 0.0));
    self.end = min(min(high.x, high.y), min(high.z, limit));
    ivec3 last = (grid.size - 1) / int(BRICK);
    self.brick = clamp(ivec3(floor((self.start + self.way * self.along) / BRICK)), ivec3(0), last);
    int axis;
    self.stop = min(max(end_of_brick(self, axis), self.way), self.end);
    return self;
}

// Goes on to the next brick.
void leave_brick(inout March self, Medium grid) {
    int axis;
    float end = end_of_brick(self, axis);
    int number = self.brick[axis] + (self.along[axis] > 0.0 ? 1 : -1);
    self.way = self.stop;
    if (number < 0 || number > (grid.size[axis] - 1) / int(BRICK)) {
        self.way = self.end;
        return;
    }
    self.brick[axis] = number;
    end = end_of_brick(self, axis);
    self.stop = min(max(end, self.way), self.end);
}

// The density that no place in the brick exceeds.
float top_of_brick(Medium grid, ivec3 brick) {
    ivec3 count = (grid.size - 1) / int(BRICK) + 1;
    int first = grid.first + grid.size.x * grid.size.y * grid.size.z;
    int number = (brick.z * count.y + brick.y) * count.x + brick.x;
    float top = grid.top * voxel_at(first + number).x;
    return top;
}

// The density at a place in voxels.
float density_at(Medium grid, vec3 place) {
    vec3 at = clamp(place - 0.5, vec3(0.0), vec3(grid.size - 1));
    vec3 corner = floor(at);
    vec3 beyond = at - corner;
    ivec3 voxel = ivec3(corner);
    int layer = grid.size.x * grid.size.y;
    int number = grid.first + (voxel.z * layer + voxel.y * grid.size.x + voxel.x);
    vec4 near = voxel_at(number);
    vec4 far = voxel_at(voxel.z + 1 < grid.size.z ? number + layer : number);
    vec4 between = near + beyond.z * (far - near);
    vec2 row = between.xy + beyond.y * (between.zw - between.xy);
    float density = grid.top * (row.x + beyond.x * (row.y - row.x));
    return density;
}

bool has_grid(Medium medium) {
    return medium.size.x > 0;
}

// The extinction of the fictitious medium, per unit of length and of density. A medium that shines collides
// LEAST_COLLISIONS times on its way at least, on average, though it may take no light.
vec3 fictitious(Medium medium) {
    if (medium.emission == vec3(0.0) || medium.top == 0.0) return medium.extinction;
    vec3 boxes = vec3(length(medium.x), length(medium.y), length(medium.z)) / vec3(medium.size);
    float least = LEAST_COLLISIONS / medium.top * max(max(boxes.x, boxes.y), boxes.z);
    return max(medium.extinction, vec3(least));
}

// The share of light that comes over this distance, with the light that the medium emits on it.
struct GridShare {
    vec3 share;
    vec3 glow;
};

GridShare cross_grid(Medium medium, Ray ray, float distance) {
    vec3 rates = fictitious(medium);
    float rate = max(max(rates.x, rates.y), rates.z);
    GridShare found = GridShare(vec3(1.0), vec3(0.0));
    March march = enter_grid(medium, ray, distance);
    float depth = depth_of(next_of_collision());
    while (march.way < march.end) {
        float top = top_of_brick(medium, march.brick);
        float room = rate * top * (march.stop - march.way);
        if (depth >= room) {
            depth -= room;
            leave_brick(march, medium);
            continue;
        }
        march.way += depth / (rate * top);
        float density = density_at(medium, march.start + march.way * march.along);
        float part = density / (rate * top);
        found.glow += found.share * part * medium.emission;
        found.share *= max(1.0 - part * medium.extinction, 0.0);
        if (found.share == vec3(0.0)) return found;
        depth = depth_of(next_of_collision());
    }
    note_end(march.way < march.end ? 0 : 1, 1);
    return found;
}
