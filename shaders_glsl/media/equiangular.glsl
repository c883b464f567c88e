// Light of near lamps along a segment through a medium: one more sample on each flight, at a place that is chosen by the
// angle under which a lamp sees the segment (Kulla and Fajardo, "Importance Sampling Techniques for Path Tracing in
// Participating Media", EGSR 2012, eq. 6). Collisions find the same light; the power heuristic weighs the two, and
// scattering that meets the lamp.

// Data of the last segment on which such a sample was taken.
struct Approach {
    vec3 origin;
    vec3 direction;
    float end;      // length of the segment, FAR for none
    float way;      // from the origin to the collision
    float density;  // of that collision; 0: no such sample was taken
    float total;    // of `nearness` of all lamps
};

Approach no_approach() {
    return Approach(vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, 0.0);
}

// A lamp, seen from a segment.
struct Sight {
    float foot;    // distance along the segment to the point next to the lamp
    float height;  // distance of that point from the lamp, or the size of the lamp
    float angle;   // that the segment fills, seen from the lamp
};

Sight sight_of(Approach self, Cluster lamp) {
    vec3 to = lamp.center - self.origin;
    float foot = dot(to, self.direction);
    vec3 aside = to - foot * self.direction;
    float height = sqrt(max(dot(aside, aside), lamp.reach2));
    float angle = angle_of(height, height * (height / self.end) - foot * (1.0 - foot / self.end));
    return Sight(foot, height, angle);
}

// The density of a place at this distance along the segment.
float pdf_equiangular(Sight sight, float way) {
    float aside = way - sight.foot;
    float square = sight.height * sight.height + aside * aside;
    float pdf = sight.height / (sight.angle * square);
    return pdf;
}

float sample_equiangular(Sight sight, float u) {
    float angle = u * sight.angle;
    float square = sight.height * sight.height + sight.foot * sight.foot;
    float way = sin(angle) * square / (sight.height * cos(angle) + sight.foot * sin(angle));
    return way;
}

// About the light that a lamp sends to the segment: its flux over squared distances, summed along it.
float nearness(Sight sight, Cluster lamp) {
    float light = lamp.probability * sight.angle / sight.height;
    return light;
}

// The density of the sample on the segment over that of the collision, for a lamp that light sampling chooses there
// with the chance `choice`. 0 without such a sample.
float rivalry(Approach self, int light, float choice) {
    if (self.density == 0.0 || choice == 0.0) return 0.0;
    Cluster lamp = cluster_at(light);
    Sight sight = sight_of(self, lamp);
    float pdf = nearness(sight, lamp) / self.total * pdf_equiangular(sight, self.way);
    float ratio = pdf / (self.density * choice);
    return ratio;
}

// The weight of light that is sampled where a path collides. `other`: density with which scattering would have met it.
float weight_beside_approach(float pdf, float other, float rivalry) {
    float ratio = other / pdf;
    float weight = 1.0 / (1.0 + rivalry * rivalry + ratio * ratio);
    return weight;
}
