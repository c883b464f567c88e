// A path between two vertices: it flies through media, across any number of bounds, until it collides or meets a
// surface.
//
// One channel decides how far it flies; the density contains the chances of all three (Wilkie et al., "Hero
// Wavelength Spectral Sampling", EGSR 2014, eq. 6). A chance is the channel's share of the throughput, so no weight
// exceeds the sum of the throughput.

struct Flight {
    int medium;     // around the next segment, or NO_MEDIUM
    int channel;    // decides
    float depth;    // optical depth in that channel, from here to the collision
    vec3 chances;   // of the channels
    vec3 left;      // share of light that scattering media have left since the last vertex
    vec4 dice;      // for a sample along the segment (media/equiangular.glsl); x below 0: it was taken
};

Flight start_flight(int medium) {
    return Flight(medium, 0, 0.0, vec3(1.0), vec3(1.0), vec4(-1.0));
}

// Draws how far the path flies from a vertex with this throughput, which is not black.
void begin_flight(inout Flight flight, vec3 throughput, inout Sampler rng) {
    vec2 u = next_2d(rng);
    flight.chances = throughput / (throughput.x + throughput.y + throughput.z);
    float red = flight.chances.x;
    bool is_blue = u.x >= red + flight.chances.y && flight.chances.z > 0.0;
    flight.channel = u.x < red ? 0 : is_blue ? 2 : 1;
    flight.depth = depth_of(u.y);
    flight.left = vec3(1.0);
    if (HAS_EQUIANGULAR) {
        vec2 place = next_2d(rng);
        flight.dice = vec4(place, next_2d(rng));
    }
}

// The factor of the throughput, where the flight has come so far without a collision.
vec3 weight_of_flight(Flight flight) {
    if (flight.left == vec3(1.0)) return vec3(1.0);
    float chance = dot(flight.chances, flight.left);
    if (chance == 0.0) return vec3(0.0);
    vec3 weight = flight.left / chance;
    return weight;
}

float density_of_collision(Flight flight, Medium medium) {
    float density = dot(flight.chances, flight.left * medium.extinction);
    return density;
}

// The same where it collides, with what the medium absorbs.
vec3 weight_of_collision(Flight flight, Medium medium) {
    float density = density_of_collision(flight, medium);
    if (density == 0.0) return vec3(0.0);
    vec3 weight = flight.left * medium.scattering / density;
    return weight;
}

// Flies over a distance through a medium that is the same everywhere. True if the path collides on its way, `way` from
// the start.
bool flies_into(inout Flight flight, Medium medium, float distance, inout float way) {
    float extinction = medium.extinction[flight.channel];
    float depth = extinction * distance;
    bool is_met = flight.depth < depth;
    way = is_met ? flight.depth / extinction : distance;
    flight.left *= share_left(medium.extinction, way);
    flight.depth -= depth;
    return is_met;
}

// The share of light that reaches a point from `distance` away, through media and their bounds; 0 where a surface
// stands between. `lamp`: the shape that the light comes from, or NO_SHAPE; `volumes`: around the start.
vec3 light_left(Ray ray, float distance, int lamp, int medium, uint volumes) {
    if (COUNT_RAYS) rays_so_far += 1.0;
    bool is_shared = HAS_COINCIDENT && lamp != NO_SHAPE && !(HAS_SPHERE && up_to_sphere(lamp));
    float limit = is_shared ? FAR : distance;
    vec3 depth = vec3(0.0);
    vec3 left = vec3(1.0);  // by grids
    uint passed = 0u;
    for (; passed <= MOST_HOLES; passed += 1u) {
        Hit hit = find_hit(ray, limit, is_shared ? NO_SHAPE : lamp, false);
        bool arrives = hit.shape == (is_shared ? lamp : NO_SHAPE);
        if (MARCHES && medium != NO_MEDIUM && has_grid(medium_at(medium))) {
            left *= march_across(medium, ray, hit.distance).share;
        } else if (HAS_TRANSFER && is_classified(medium)) {
            left *= cross_classified(medium, ray, hit.distance).share;
        } else if (HAS_GRID && medium != NO_MEDIUM && has_grid(medium_at(medium))) {
            left *= cross_grid(medium_at(medium), ray, hit.distance).share;
        } else if (medium != NO_MEDIUM) {
            depth += hit.distance * medium_at(medium).extinction;
        }
        if (arrives) {
            left *= vec3(decay(depth.x), decay(depth.y), decay(depth.z));
            return left;
        }
        if (!MAY_PASS || hit.shape == NO_SHAPE) return vec3(0.0);
        Surface surface = surface_at(ray, hit);
        int object = object_number(surface.shape);
        if (!is_passed(material_of(ray, surface), passed, volumes, object)) return vec3(0.0);
        if (limit < FAR) limit -= hit.distance;
        ray = beyond(ray, surface);
        cross_bounds(medium, volumes, object, ray.inward);
    }
    note_end(int(passed), int(MOST_HOLES) + 2);
    return vec3(0.0);
}
