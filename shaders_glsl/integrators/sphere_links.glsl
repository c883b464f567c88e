// Links through one sphere: the ways of light between a vertex and the eye by one reflection outside a smooth sphere,
// or through a ball of glass by two refractions with 0 or 1 reflections between them. LINKED: a bit for each sphere
// that has links, by its number; nothing lies within such a sphere (glrt/plan/particles.py).
//
// A link lies in the plane of the eye, the vertex and the centre. The angle of incidence t is its one unknown. Seen
// from the centre, the way turns by D(t), not counting half a turn for each chord:
//     D(t) = 2 t - asin(ke sin t) - asin(kv sin t) - 2 chords asin(sin t / ior),
// ke, kv: the radius over the distances of eye and vertex. Light takes that way where D is psi or -psi. psi is the
// angle between eye and vertex (for an odd number of chords: between the eye and the opposite of the vertex). Each
// asin(k sin t) with k < 1 is concave in t, so D is convex. Either D rises from 0 at once and meets psi at most once;
// or it falls first, meets -psi falling and rising, and then meets psi. Its slope is at most 2, so that no angle is
// off by a whole turn.

const int MOST_CHORDS = 2;
const float REFLECTED = 0.125;    // share of links of glass by a reflection outside, and share by one inside
const float FLAT = 0.0625;        // least |dD/dt| of a link: camera paths serve where the image folds over
const float CLOSE = 0.0009765625; // 2^-10 radians: one Newton step from there meets D as well as floats can
const int ROUNDS = 12;            // Newton steps, at most

// Geometry of the links between an eye, a vertex and a sphere.
struct Arc {
    vec3 to_eye;     // unit, from the centre
    vec3 to_vertex;  // unit, from the centre
    vec3 ratios;     // sines at the eye, at the vertex and inside, over the sine of the angle of incidence
    float radius;
    float cosine;    // of the angle between to_eye and to_vertex
    float sine;
    int chords;
};

Arc arc_of(vec3 eye, vec3 vertex, Sphere sphere, float ior, int chords) {
    vec3 u = eye - sphere.center;
    vec3 v = vertex - sphere.center;
    vec3 inverses = 1.0 / vec3(length(u), length(v), chords > 0 ? ior : 1.0);
    vec3 to_eye = u * inverses.x;
    vec3 to_vertex = v * inverses.y;
    float cosine = dot(to_eye, to_vertex);
    float sine = length(cross(to_eye, to_vertex));
    vec3 ratios = inverses * vec3(sphere.radius, sphere.radius, chords > 0 ? 1.0 : 0.0);
    return Arc(to_eye, to_vertex, ratios, sphere.radius, cosine, sine, chords);
}

// The same for a vertex at infinity, in the direction `towards`: the sun, or a place of the sky.
Arc arc_to_afar(vec3 eye, vec3 towards, Sphere sphere, float ior, int chords) {
    vec3 u = eye - sphere.center;
    float inverse = 1.0 / length(u);
    vec3 to_eye = u * inverse;
    float inside = chords > 0 ? 1.0 / ior : 0.0;
    vec3 ratios = vec3(sphere.radius * inverse, 0.0, inside);
    return Arc(to_eye, towards, ratios, sphere.radius, dot(to_eye, towards), length(cross(to_eye, towards)), chords);
}

float first_slope(Arc arc) {
    float slope = 2.0 - arc.ratios.x - arc.ratios.y - 2.0 * float(arc.chords) * arc.ratios.z;
    return slope;
}

// Whether links may exist: eye and vertex lie outside the sphere and not in line with its centre, and D falls by less
// than half a turn.
bool has_links(Arc arc) {
    return arc.ratios.x < 1.0 && arc.ratios.y < 1.0 && arc.sine > 0.0 && first_slope(arc) > -2.0;
}

float cosine_of(float sine) {
    float cosine = sqrt(max((1.0 - sine) * (1.0 + sine), 0.0));
    return cosine;
}

// Cosines of the angles at which the way meets the eye, the vertex, and the sphere from inside.
vec3 cosines_along(Arc arc, float sine) {
    vec3 s = arc.ratios * sine;
    vec3 cosines = sqrt(max((1.0 - s) * (1.0 + s), 0.0));
    return cosines;
}

// dD / dt.
float slope_of(Arc arc, vec3 cosines, float cosine) {
    vec3 each = arc.ratios / cosines;
    float slope = 2.0 - cosine * (each.x + each.y + 2.0 * float(arc.chords) * each.z);
    return slope;
}

// An angle of incidence, given by the tangent of its half.
struct Incidence {
    float half_tangent;
    float sine;
    float cosine;
};

Incidence incidence_of(float half_tangent) {
    float square = half_tangent * half_tangent;
    float over = 1.0 / (1.0 + square);
    float sine = 2.0 * half_tangent * over;
    float cosine = (1.0 - square) * over;
    return Incidence(half_tangent, sine, cosine);
}

// Turns `a` back by the angle of `b`, as complex numbers of size 1.
vec2 turned_back(vec2 a, vec2 b) {
    vec2 turned = vec2(a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y);
    return turned;
}

// A way through the sphere: where D meets psi or -psi, rising or falling.
struct Branch {
    float sign;  // of psi
    bool falls;
};

// Sense of the turn about the centre: 1 from the eye towards the vertex, -1 the other way round.
float sense_of(Branch branch, int chords) { return chords == 1 ? -branch.sign : branch.sign; }

// D less the angle of a branch. Beyond a few degrees the result is too small, by a third at half a turn.
float miss_of(Arc arc, Incidence at, vec3 cosines, Branch branch) {
    vec3 sines = arc.ratios * at.sine;
    vec2 half_way = vec2(at.cosine, at.sine);
    vec2 inside = vec2(cosines.z, sines.z);
    if (arc.chords > 0) half_way = turned_back(half_way, inside);
    if (arc.chords > 1) half_way = turned_back(half_way, inside);
    vec2 turn = turned_back(half_way, vec2(cosines.x, sines.x));
    vec2 rest = turned_back(half_way, vec2(cosines.y, sines.y));
    turn = turned_back(turn, vec2(rest.x, -rest.y));
    float parity = arc.chords == 1 ? -1.0 : 1.0;
    turn = turned_back(turn, vec2(parity * arc.cosine, branch.sign * arc.sine));
    float half_tangent = turn.x > 0.0 ? turn.y / (1.0 + turn.x) : turn.y > 0.0 ? 1.0 : -1.0;
    float miss = 2.0 * half_tangent * (1.0 - half_tangent * half_tangent / 3.0);
    return miss;
}

// The half tangent of t where D meets the angle of a branch; -1: nowhere. Newton's method starts at the end of the
// convex curve. It goes towards the angle and not beyond, since its steps are never too long. There is no solution
// if the slope changes its sign before the method gets there.
float meeting_of(Arc arc, Branch branch) {
    float m = branch.falls ? 0.0 : 1.0;
    float found = -1.0;
    for (int i = 0; i < ROUNDS; ++i) {
        Incidence at = incidence_of(m);
        vec3 cosines = cosines_along(arc, at.sine);
        float miss = miss_of(arc, at, cosines, branch);
        float slope = slope_of(arc, cosines, at.cosine);
        float way = miss / slope;
        float half_way = 0.5 * way;
        float half_tangent = half_way * (1.0 + half_way * half_way / 3.0);  // or a little less
        m = (m - half_tangent) / (1.0 + m * half_tangent);
        bool is_close = abs(way) < CLOSE;
        if (is_close) found = clamp(m, 0.0, 1.0);
        if (is_close || branch.falls != slope < 0.0 || miss < 0.0 || !(m >= 0.0 && m <= 1.0)) break;
    }
    return found;
}

// Angles where a way meets the sphere.
struct Crossing {
    vec3 cosines;  // from cosines_along
    float sine;    // of the angle of incidence
    float cosine;
    float slope;   // dD / dt
};

Crossing crossing_of(Arc arc, float sine) {
    float cosine = cosine_of(sine);
    vec3 cosines = cosines_along(arc, sine);
    return Crossing(cosines, sine, cosine, slope_of(arc, cosines, cosine));
}

// Solid angle at the eye over area at the vertex, across the ray, or over solid angle if the vertex is at infinity; 0: no
// link.
float spread_of(Arc arc, Crossing at) {
    float over = at.cosines.x * at.cosines.y * arc.sine * abs(at.slope);
    bool is_finite_there = over > 0.0 && over < FAR;  // false where a way leaves along the sphere
    if (!is_finite_there || abs(at.slope) < FLAT || !has_links(arc)) return 0.0;
    float across = arc.ratios.y > 0.0 ? arc.ratios.x * arc.ratios.y / arc.radius : arc.ratios.x;
    float spread = across * across * at.sine * at.cosine / over;
    return spread;
}

// The probability that a path which meets the sphere takes this way: Fresnel's share at each surface.
float chance_of(Material material, Crossing at, int chords) {
    if (!(HAS_DIELECTRIC && material.kind == DIELECTRIC)) return 1.0;
    float reflected = fresnel(at.cosine, 1.0 / material.ior);
    float passed = (1.0 - reflected) * (1.0 - reflected);
    float chance = chords == 0 ? reflected : chords == 1 ? passed : passed * reflected;
    return chance;
}

// Share of light that this way leaves, without its chance: the colour of a mirror, or the transmittance of glass.
vec3 tint_of(Material material, Arc arc, Crossing at) {
    if (!(HAS_DIELECTRIC && material.kind == DIELECTRIC)) return metal_reflectance(material, at.cosine);
    if (!HAS_ATTENUATION) return vec3(1.0);
    float inside = float(2 * arc.chords) * arc.radius * at.cosines.z;
    return share_left(absorption_of_glass(material.details), inside);
}

// A link is tried through one sphere, drawn evenly. Then the number of its chords is drawn, and one of the branches
// that may exist.
int draw_chords(Material material, float u) {
    bool is_glass = HAS_DIELECTRIC && material.kind == DIELECTRIC;
    return !is_glass || u < REFLECTED ? 0 : u < 1.0 - REFLECTED ? 1 : 2;
}

// The share of draws that take one sphere with `chords` chords.
float share_of_draws(Material material, int chords) {
    float share = 1.0 / float(bitCount(LINKED));
    if (!(HAS_DIELECTRIC && material.kind == DIELECTRIC)) return share;
    share *= chords == 1 ? 1.0 - 2.0 * REFLECTED : REFLECTED;
    return share;
}

// Where D falls first, half of the draws take the falling branch, and SIDE of them each of the other two.
const float SIDE = 0.25;

Branch draw_branch(Arc arc, float u) {
    if (first_slope(arc) >= 0.0) return Branch(1.0, false);
    return Branch(u < SIDE ? 1.0 : -1.0, u >= 0.5);
}

float share_of_branch(Arc arc, bool falls) {
    return first_slope(arc) >= 0.0 ? 1.0 : falls ? 0.5 : SIDE;
}

// Density of a way from the camera, on the film and per area of the vertex. `cosine`: between the way and the normal of
// the vertex. `film`: density of the ray per solid angle.
float pdf_of_way(float film, Material material, Arc arc, Crossing at, float cosine) {
    float pdf = film * cosine * spread_of(arc, at) * chance_of(material, at, arc.chords);
    return pdf;
}

// How many particles for each sample of a pixel are linked this way, if they come to the vertex.
float linked_this_way(Material material, Arc arc, Crossing at) {
    float share = share_of_draws(material, arc.chords) * share_of_branch(arc, at.slope < 0.0);
    float count = frame.particles * frame.linked * share;
    return count;
}

// rho of particle_weights.glsl for a way, times the density of the particles; see pdf_of_way.
float rho_of_way(float film, Material material, Arc arc, Crossing at, float cosine) {
    float rho = pdf_of_way(film, material, arc, at, cosine) / linked_this_way(material, arc, at);
    return rho;
}

// --- the camera's side -----------------------------------------------------------------------

// The smooth spheres that a path from the camera has met before its first vertex that is no delta.
struct Chain {
    int state;
    int sphere;
    int chords;
    float sine;  // of the angle of incidence
    vec3 eye;
    float film;  // density of the ray from the camera, per solid angle
};

const int UNBROKEN = 0;  // no vertex yet
const int INSIDE = 1;    // in a ball
const int LINKING = 2;   // the path has passed one sphere, by a way that particles are linked by
const int BROKEN = 3;    // by a way that no particles are linked by; or the chain has ended

Chain start_chain(Ray ray) {
    return Chain(UNBROKEN, NO_SHAPE, 0, 0.0, ray.origin, LINKED != 0 ? pdf_camera(ray.direction) : 0.0);
}

bool is_linked(int shape) { return shape < sphere_count() && shape < 31 && (LINKED >> shape & 1) != 0; }

// Updates the chain after scattering at a vertex of the object `shape`.
void follow_chain(inout Chain chain, int shape, Vertex vertex, bool crosses) {
    if (LINKED == 0) return;
    int before = chain.state;
    chain.state = BROKEN;
    if (!is_delta(vertex.material)) return;
    if (before == UNBROKEN && is_linked(shape) && vertex.is_outside) {
        chain.sphere = shape;
        chain.sine = length(vertex.wo.xy);
        chain.state = crosses ? INSIDE : LINKING;
    } else if (before == INSIDE) {  // there is nothing else to meet
        chain.chords += 1;
        chain.state = crosses ? LINKING : INSIDE;
        if (chain.chords > MOST_CHORDS) chain.state = BROKEN;
    }
}

// rho that particles linked through a sphere are weighed against, at a vertex; `cosine`: at its normal.
float rho_of_link(Chain chain, vec3 position, float cosine) {
    if (chain.state != LINKING) return 0.0;
    Sphere sphere = sphere_at(chain.sphere);
    Material material = material_at(sphere.material);
    Arc arc = arc_of(chain.eye, position, sphere, material.ior, chain.chords);
    return rho_of_way(chain.film, material, arc, crossing_of(arc, chain.sine), cosine);
}

// The same for light from infinity, in the direction `towards`, per solid angle.
float rho_of_afar(Chain chain, vec3 towards) {
    Sphere sphere = sphere_at(chain.sphere);
    Material material = material_at(sphere.material);
    Arc arc = arc_to_afar(chain.eye, towards, sphere, material.ior, chain.chords);
    return rho_of_way(chain.film, material, arc, crossing_of(arc, chain.sine), 1.0);
}
