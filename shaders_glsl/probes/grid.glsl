// Probes: a grid of points, each with maps of the light and of the distances around it (Majercik et al., "Dynamic
// Diffuse Global Illumination with Ray-Traced Irradiance Fields", JCGT 2019). glrt/plan/probe_grid.py places it.

const int LIGHT_SIDE = 6;      // inner texels along an edge of a map of irradiance
const int DISTANCE_SIDE = 14;  // inner texels along an edge of a map of distances
const int PROBES_IN_ROW = 64;  // of the textures that hold the maps

// The number of a probe: x counts fastest, z slowest.
int probe_at(ivec3 cell) {
    return (cell.z * frame.probe_counts.y + cell.y) * frame.probe_counts.x + cell.x;
}

ivec3 cell_of_probe(int probe) {
    ivec2 counts = frame.probe_counts.xy;
    return ivec3(probe % counts.x, probe / counts.x % counts.y, probe / (counts.x * counts.y));
}

// The place of a probe that was not pushed.
vec3 middle_of_cell(int probe) {
    vec3 middle = frame.probe_first + vec3(cell_of_probe(probe)) * frame.probe_cell;
    return middle;
}

// A place relative to the first probe, in cells.
vec3 place_in_grid(vec3 position) {
    vec3 place = (position - frame.probe_first) / frame.probe_cell;
    return place;
}

// The share of light at a place that probes give: 1 in their cells, falling to 0 over one cell beyond.
float share_of_probes(vec3 position) {
    vec3 place = place_in_grid(position);
    vec3 beyond = max(-0.5 - place, place + 0.5 - vec3(frame.probe_counts));
    float farthest = max(beyond.x, max(beyond.y, beyond.z));
    float share = clamp(1.0 - farthest, 0.0, 1.0);
    return share;
}

ivec2 corner_of_map(int probe, int side) {
    return (side + 2) * ivec2(probe % PROBES_IN_ROW, probe / PROBES_IN_ROW);
}
