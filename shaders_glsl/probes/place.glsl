// A probe in a solid, outside of the room that contains the camera, or close to a surface is pushed aside, at most to
// the edge of its cell. Such a place shows by wrong faces of solids: the camera does not lie on their side.

const float MOST_WRONG = 0.25;    // share of wrong faces among met surfaces: above it, the probe is in a solid
const float NEAR_SURFACE = 0.05;  // of the shortest edge of a cell: the least distance of a probe from surfaces
const float MOST_PUSHED = 0.45;   // of a cell, along each edge

// Surfaces that the rays of a probe have met.
struct Surroundings {
    int rays;  // number of rays that met something
    int wrong;
    vec3 nearest_wrong;  // the way to the nearest wrong face; of length 0: none
    vec3 nearest_right;
};

Surroundings nothing_around() {
    return Surroundings(0, 0, vec3(0.0), vec3(0.0));
}

bool is_nearer(vec3 way, vec3 known) {
    return known == vec3(0.0) || dot(way, way) < dot(known, known);
}

// Adds one ray. `distance`: as the rays of probes report it, below 0 for a wrong face.
void look(inout Surroundings around, vec3 direction, float distance) {
    if (distance == 0.0 || distance >= FAR) return;
    around.rays += 1;
    vec3 way = direction * (distance < 0.0 ? distance / WRONG_FACE : distance);
    if (distance < 0.0) {
        around.wrong += 1;
        if (is_nearer(way, around.nearest_wrong)) around.nearest_wrong = way;
    } else if (is_nearer(way, around.nearest_right)) {
        around.nearest_right = way;
    }
}

bool is_in_solid(Surroundings around) {
    return float(around.wrong) > MOST_WRONG * float(around.rays);
}

// The next offset of a probe from the middle of its cell: through the nearest wrong face, or away from a close surface.
vec3 pushed(Surroundings around, vec3 offset) {
    float near = NEAR_SURFACE * frame.probe_edge;
    vec3 next = offset;
    if (is_in_solid(around)) {
        next += around.nearest_wrong + near * normalized(around.nearest_wrong);
    } else if (around.nearest_right != vec3(0.0)) {
        float distance = length(around.nearest_right);
        if (distance < near) next -= (near - distance) / distance * around.nearest_right;
    }
    vec3 most = MOST_PUSHED * frame.probe_cell;
    if (any(greaterThan(abs(next), most))) return offset;
    return next;
}
