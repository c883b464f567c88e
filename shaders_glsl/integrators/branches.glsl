// Whitted's tree: at glass a path goes on as two. One waits until the other has ended, and both add to one sample.

const int MOST_DEPTH_OF_TREE = 8;  // scattering events: at most so many branches wait

Path branches[MOST_DEPTH_OF_TREE];
int branch_count = 0;

void keep_branch(Path branch) {
    branches[branch_count] = branch;
    branch_count += 1;
}

// Goes on with the branch that was kept last; false where none waits. The light that is gathered so far stays.
bool take_branch(inout Path path) {
    if (branch_count == 0) return false;
    branch_count -= 1;
    Path next = branches[branch_count];
    next.radiance = path.radiance;
    next.layers = path.layers;
    next.terms.light = path.terms.light;
    path = next;
    return true;
}

// Whether both rays are followed at this surface.
bool is_split(Material material) {
    return HAS_DIELECTRIC && material.kind == DIELECTRIC || HAS_PANE && material.kind == PANE;
}

// The reflected ray, weighed by its share; the ray through the surface is kept as a branch.
Scattering split_path(Path path, Meeting at) {
    bool is_pane = HAS_PANE && at.vertex.material.kind == PANE;
    float share = fresnel(at.vertex.wo.z, at.vertex.eta);
    if (is_pane) share = pane_reflectance(at.vertex.wo.z, at.vertex.material.ior);
    Scattering reflected = is_pane ? sample_pane(at.vertex, -1.0) : sample_dielectric(at.vertex, -1.0);
    reflected.weight *= share;
    if (share >= 1.0) return reflected;
    Scattering crossing = is_pane ? sample_pane(at.vertex, 1.0) : sample_dielectric(at.vertex, 1.0);
    if (is_lost(at, crossing)) return reflected;
    if (LIGHT_TERMS != 0) sort_by_surface(path, at.vertex, crossing.direction, crossing.pdf, true);
    path.throughput *= (1.0 - share) * crossing.weight;
    path.scale *= crossing.scale;
    leave(path, at, crossing);
    path.passed = Passed(0u, path.ray, 0.0);
    path.pdf = crossing.pdf;
    keep_branch(path);
    return reflected;
}
