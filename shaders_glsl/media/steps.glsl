// Ray marching, the method `march`: media whose density varies are crossed in steps of a fixed length, each filled with
// the density in its middle (Max, "Optical Models for Direct Volume Rendering", IEEE TVCG 1995). Where density is
// smooth, the error falls with the square of the length. Details between two middles are not seen.

// (1 - exp(-x d)) / x: the integral of what is left of light, over the distance d. The series is right to 2e-8.
float integral_of_decay(float x, float d) {
    float depth = x * d;
    float p = 1.0 / 24.0 - depth / 120.0;
    p = 1.0 / 6.0 - p * depth;
    p = 0.5 - p * depth;
    float integral = depth > 0.1 ? (1.0 - decay(depth)) / x : d * (1.0 - p * depth);
    return integral;
}

vec3 integral_of_decay(vec3 x, float d) {
    return vec3(integral_of_decay(x.x, d), integral_of_decay(x.y, d), integral_of_decay(x.z, d));
}

float length_of_step(Medium grid) {
    float voxels = max(max(length(grid.x), length(grid.y)), length(grid.z));  // per unit of length
    float step = frame.march_step > 0.0 ? frame.march_step : 1.0 / voxels;
    return step;
}

// Steps of a march through a grid.
struct Steps {
    March march;
    float size;
    float begin;  // of the step, along the ray
    float end;
    float count;  // steps so far
};

Steps first_step(Medium grid, Ray ray, float limit) {
    March march = enter_grid(grid, ray, limit);
    float size = length_of_step(grid);
    return Steps(march, size, march.way, min(march.way + size, march.end), 1.0);
}

bool is_in_grid(Steps self) {
    return self.begin < self.march.end;
}

void next_step(inout Steps self) {
    self.count += 1.0;
    self.begin = self.end;
    self.end = min(self.march.way + self.count * self.size, self.march.end);
}

// The medium that fills a step: everywhere as in the middle.
Medium medium_of_step(int row, Medium medium, Steps self) {
    float middle = 0.5 * (self.begin + self.end);
    float density = density_at(medium, self.march.start + middle * self.march.along);
    if (HAS_TRANSFER && is_classified(row)) {
        Knot seen = classify(row, knots_of(medium), density);
        float rate = extinction_of(seen.opacity, medium.extinction.y);
        medium.extinction = vec3(rate);
        medium.emission = rate * seen.color;
        return medium;
    }
    medium.scattering *= density;
    medium.extinction *= density;
    medium.emission *= density;
    return medium;
}

// Like `cross_grid` and `cross_classified`.
GridShare march_across(int row, Ray ray, float distance) {
    Medium medium = medium_at(row);
    GridShare found = GridShare(vec3(1.0), vec3(0.0));
    Steps steps = first_step(medium, ray, distance);
    while (is_in_grid(steps)) {
        Medium even = medium_of_step(row, medium, steps);
        float way = steps.end - steps.begin;
        found.glow += found.share * even.emission * integral_of_decay(even.extinction, way);
        found.share *= share_left(even.extinction, way);
        next_step(steps);
    }
    note_end(is_in_grid(steps) ? 0 : 1, 1);
    return found;
}
