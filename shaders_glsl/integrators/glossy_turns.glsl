// Surfaces that are neither matte nor smooth. Their densities differ between the two directions of a path. A path from
// the camera that comes from wo takes light from wi by the value V(wo, wi), which contains the cosine. It goes to wi
// with the density p(wo, wi). A particle comes from wi and goes to wo as a path from the camera would, with the density
// p(wi, wo). g is the true normal. A particle carries on the arriving flux, spread by V, over its density:
//     V(wo, wi) |wo . g| / (|wi . g| p(wi, wo))
// P0 over PL (integrators/particle_weights.glsl) is the same with p(wo, wi) in place of V. A link to the camera has no
// p(wi, wo); PI replaces it, because rho contains that factor of matte surfaces:
//     V(wo, wi) / |wi . g|   and   PI p(wo, wi) / |wi . g|
// Nothing here requires a symmetric V. Normals for shading are contained in V and p.

const bool HAS_GLOSSY = HAS_ROUGH_METAL || HAS_ROUGH_GLASS || HAS_ROUGH_PANE || HAS_PRINCIPLED;

bool is_glossy(Material material) { return HAS_GLOSSY && material.kind != MATTE && !is_delta(material); }

// Whether a glossy surface scattered by a part that is a delta: a smooth coat or smooth facets. Such a part mirrors a
// path and a particle with the same chance. Light that it mirrors at a vertex is no light of sampling or of a link there.
bool is_mirrored(Vertex vertex, float pdf) {
    return HAS_PRINCIPLED && vertex.material.kind == PRINCIPLED && pdf == 0.0;
}

// The factor of shading_normals.glsl for such an event; 0 where a path and a particle scatter around different normals.
float mirrored_turn(Normals at, vec3 wi, vec3 wo) {
    if (!HAS_SHADING) return 1.0;
    bool is_flat = is_flat_towards(at, wo);
    if (is_flat != is_flat_towards(at, wi)) return 0.0;
    return turn_around(is_flat ? at.facing : at.shading, at.facing, wi, wo, true);
}

// Normals on the side of w, from normals on either side.
Normals normals_towards(Normals at, vec3 w) {
    float side = dot(w, at.facing) < 0.0 ? -1.0 : 1.0;
    return Normals(side * at.facing, side * at.shading);
}

// The same vertex for a path that comes from w; `at`: normals on the side of the vertex's wo.
Vertex vertex_from(Vertex vertex, Normals at, vec3 w) {
    bool crosses = dot(w, at.facing) < 0.0;
    Normals there = normals_towards(at, w);
    mat3 frame = shading_frame(there.facing, HAS_SHADING ? there.shading : there.facing, -w);
    float eta = crosses ? 1.0 / vertex.eta : vertex.eta;
    if (HAS_ANISOTROPY) frame = frame_along(frame, vertex.along);
    vec3 wo = to_local(frame, w);
    bool is_outside = vertex.is_outside != crosses;
    return Vertex(frame, wo, vertex.material, is_outside, eta, vertex.along, vertex.stretch, vec3(eta));
}

// V and p of a direction wi of the world; 0 where no path goes there. `facing`: the true normal on the side of wo.
ColorLobe lobe_towards(Vertex vertex, vec3 facing, vec3 wi) {
    vec3 local = to_local(vertex.frame, wi);
    bool crosses = local.z < 0.0;
    bool is_lost = crosses ? !scatters_across(vertex.material) : local.z == 0.0;
    if (is_lost || HAS_SHADING && crosses != dot(wi, facing) < 0.0) return ColorLobe(vec3(0.0), 0.0);
    vec3 value = eval_material(vertex, local);
    float pdf = pdf_material(vertex, local);
    return ColorLobe(value, pdf);
}

// Factors of a link to the camera, or of a scattering event: of a particle's light, and of its P0 over PL.
struct Turn {
    vec3 value;
    float turn;
};

// Factors of a link of light that comes from wi and goes to wo, at any surface that is not smooth. `at`: see
// vertex_from. The vertex's frame is around the true normal.
Turn turn_of_link(Vertex vertex, Normals at, vec3 wi, vec3 wo) {
    if (!is_glossy(vertex.material)) {
        float turn = turn_towards(at, wi, wo, false);
        vec3 share = turn * (vertex.material.color / PI);
        return Turn(share, turn);
    }
    ColorLobe lobe = lobe_towards(vertex_from(vertex, at, wo), normals_towards(at, wo).facing, wi);
    float arriving = abs(dot(wi, at.facing));
    vec3 value = lobe.value / arriving;
    float density = PI * lobe.pdf / arriving;
    return Turn(value, density);
}

// P0 over PL of a path from the camera that goes to wi; 0 where no particle takes this way. `is_linked`: whether
// particles are linked to the camera here.
float glossy_turn(Vertex vertex, Normals at, vec3 wi, bool is_linked) {
    vec3 wo = normalized(vertex.frame * vertex.wo);
    float density = lobe_towards(vertex, at.facing, wi).pdf;
    float arriving = abs(dot(wi, at.facing));
    float turn = PI * density / arriving;
    if (!is_linked) {
        float back = lobe_towards(vertex_from(vertex, at, wi), normals_towards(at, wi).facing, wo).pdf;
        turn = density * abs(dot(wo, at.facing)) / (arriving * back);
    }
    return turn > 0.0 && turn < FAR ? turn : 0.0;
}
