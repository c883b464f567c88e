// Indirect light at a point, from the eight probes around it.
//
// Each probe is weighed by its nearness, by whether it stands before the surface, and by whether the point is visible
// from it. For the last, Chebyshev's inequality bounds the chance by the mean and the variance of the distances in that
// direction. The weights and constants are those of Majercik et al. ("Scaling Probe-Based Real-Time Dynamic Global
// Illumination for Production", JCGT 2021) and of NVIDIA's RTXGI.

const float BIAS = 0.225;          // of the shortest edge of a cell: how far before a surface its light is looked up
const float BIAS_TO_NORMAL = 0.2;  // share of the bias along the normal; the rest goes along wo
const float LEAST_SEEN = 0.05;     // weight of a probe that does not see the point
const float LEAST_WEIGHT = 1e-6;
const float SMALL_WEIGHT = 0.2;    // below it weights fall to 0 faster, so that dim leaks vanish
const float LEAST_NEARNESS = 0.001;

// The chance that a point at a distance is visible from a probe whose distances have these moments: mean and mean
// square.
float chance_seen(vec2 moments, float distance) {
    if (distance <= moments.x) return 1.0;
    float variance = abs(moments.x * moments.x - moments.y);
    float beyond = distance - moments.x;
    float chance = variance / (variance + beyond * beyond);
    float seen = max(chance * chance * chance, LEAST_SEEN);
    return seen;
}

// Weight of a probe that lies in the unit direction `to_probe` from a surface.
float weight_of_side(vec3 normal, vec3 to_probe) {
    float before = (dot(to_probe, normal) + 1.0) / 2.0;
    float weight = before * before + 0.2;
    return weight;
}

// Makes small weights smaller, but never 0.
float crushed(float weight) {
    float kept = max(weight, LEAST_WEIGHT);
    if (kept < SMALL_WEIGHT) kept *= kept * kept / (SMALL_WEIGHT * SMALL_WEIGHT);
    return kept;
}

// The place before a surface where its light is looked up; `wo`: the unit direction in which the light leaves.
vec3 biased_place(vec3 position, vec3 normal, vec3 wo) {
    if (WITHOUT_BIAS) return position;
    float length = BIAS * frame.probe_edge;
    vec3 place = position + length * (BIAS_TO_NORMAL * normal + (1.0 - BIAS_TO_NORMAL) * wo);
    return place;
}

// Light of probes, and the sum of their weights; 0: no probe can be used.
struct ProbeLight {
    vec3 irradiance;
    float weight;
};

// Weight of a probe for the light at a point `position`, looked up at `place`.
float weight_of_probe(int probe, vec3 position, vec3 place, vec3 normal) {
    vec4 offset = place_of_probe(probe);
    if (offset.a == 0.0) return 0.0;
    vec3 stand = middle_of_cell(probe) + offset.xyz;
    vec3 to_probe = stand - position;
    float weight = 1.0;
    if (dot(to_probe, to_probe) > 0.0) weight = weight_of_side(normal, normalized(to_probe));
    vec3 from_probe = place - stand;
    float distance = length(from_probe);
    if (!WITHOUT_VISIBILITY && distance > 0.0) {
        weight *= chance_seen(distances_at_probe(probe, from_probe), distance);
    }
    return crushed(weight);
}

// Weight of one of eight probes by trilinear interpolation; `beyond`: how far the point lies from the first probe
// towards the last along each axis, 0 to 1.
float nearness(ivec3 corner, vec3 beyond) {
    vec3 shares = vec3(0.0);
    for (int i = 0; i < 3; i += 1) shares[i] = max(corner[i] == 1 ? beyond[i] : 1.0 - beyond[i], LEAST_NEARNESS);
    float product = shares.x * shares.y * shares.z;
    return product;
}

// Light of probes at a surface with a unit normal on the side of `wo`.
ProbeLight light_of_probes(vec3 position, vec3 normal, vec3 wo) {
    vec3 place = biased_place(position, normal, wo);
    vec3 cells = place_in_grid(place);
    ivec3 first = clamp(ivec3(floor(cells)), ivec3(0), frame.probe_counts - 2);
    vec3 beyond = clamp(cells - vec3(first), 0.0, 1.0);
    ProbeLight sum = ProbeLight(vec3(0.0), 0.0);
    for (int i = 0; i < 8; i += 1) {
        ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
        int probe = probe_at(first + corner);
        float weight = weight_of_probe(probe, position, place, normal) * nearness(corner, beyond);
        sum.weight += weight;
        sum.irradiance += weight * light_at_probe(probe, normal);
    }
    if (sum.weight > 0.0) sum.irradiance /= sum.weight;
    return sum;
}

// Adds indirect light of a matte surface from probes, which replaces the rest of the path. The path ends with the
// segment that finds the direct light of this surface. Paths go on beyond the grid, and where no probe can be used.
// Paths of a final gather also go on where they meet the first matte surface.
void gather_from_probes(inout Path path, Vertex vertex, vec3 position, inout Sampler rng) {
    if (!HAS_PROBES || vertex.material.kind != MATTE || path.depth + 2 > frame.bounces) return;
    if (!path.asking.is_due) {
        path.asking.is_due = true;
        return;
    }
    float share = share_of_probes(position);
    if (share < 1.0) {
        if (next_1d(rng) >= share) return;
    }
    vec3 normal = vertex.frame[2];
    ProbeLight found = light_of_probes(position, normal, -path.ray.direction);
    if (found.weight == 0.0) return;
    vec3 weight = path.scale * path.throughput * vertex.material.color / PI;
    if (LIGHT_TERMS != 0) sort_by_surface(path, vertex, vertex.frame[2], 1.0, false);
    gather(path, weight * found.irradiance, 0, path.depth + 2);
    path.asking.is_done = true;
}
