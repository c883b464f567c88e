// Where the middle ray of a pixel sees a medium whose density varies: where it has taken a tenth of the light behind it,
// in the mean of the channels. So history of smoke moves with the smoke, and not with what stands behind it. With the
// median of first collisions instead, the rim of a plume still moves with the background: docs/explanation/temporal.md.

const float DEPTH_OF_VOLUME = 0.105360516;  // optical depth, -ln(0.9)

// The length at which `depth` is used up in a grid, in steps as long as a voxel; FAR if some of it is left.
float length_of_depth(int row, Ray ray, float limit, inout float depth) {
    Medium medium = medium_at(row);
    Steps steps = first_step(medium, ray, limit);
    while (is_in_grid(steps)) {
        vec3 rates = medium_of_step(row, medium, steps).extinction;
        float rate = (rates.x + rates.y + rates.z) / 3.0;
        float room = rate * (steps.end - steps.begin);
        if (depth < room) {
            float met = steps.begin + depth / rate;
            return met;
        }
        depth -= room;
        next_step(steps);
    }
    note_end(is_in_grid(steps) ? 0 : 1, 1);
    return FAR;
}

// The place where the ray sees such a medium, and 1 + the number of the object whose bound it passed last; 0 for none.
vec4 middle_volume(Ray ray) {
    vec3 direction = ray.direction;
    int medium = frame.camera_medium;
    uint volumes = frame.camera_counts;
    float depth = DEPTH_OF_VOLUME;
    float object = 0.0;
    uint passed = 0u;
    for (; passed <= MOST_HOLES; passed += 1u) {
        Hit hit = find_hit(ray, FAR, NO_SHAPE, false);
        if (object > 0.0 && medium != NO_MEDIUM && has_grid(medium_at(medium))) {
            float met = length_of_depth(medium, ray, hit.distance, depth);
            if (met < FAR) {
                vec4 found = vec4(ray.origin + met * direction, object);
                return found;
            }
        }
        if (hit.shape == NO_SHAPE) return vec4(0.0);
        Surface surface = surface_at(ray, hit);
        int bound = object_number(surface.shape);
        if (!is_passed(material_of(ray, surface), passed, volumes, bound)) return vec4(0.0);
        ray = beyond(ray, surface);
        object = float(1 + bound);
        cross_bounds(medium, volumes, bound, ray.inward);
    }
    note_end(int(passed), int(MOST_HOLES) + 2);
    return vec4(0.0);
}
