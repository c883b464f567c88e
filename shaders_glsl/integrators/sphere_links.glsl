// Links through one sphere: the ways of light between a vertex and the eye by one reflection outside a smooth sphere, or
// through a ball of glass by two refractions with 0 or 1 reflections between them. LINKED: a bit for each sphere that
// has them, by its number; nothing lies within it (glrt/methods/particles.py).
//
// All of a link lies in the plane of the eye, the vertex and the centre, and the angle of incidence t is its one
// unknown. Seen from the centre, the way turns by
//     T(t) = 2 t - asin(ke sin t) - asin(kv sin t) + chords (PI - 2 asin(sin t / ior)),
// ke, kv: the radius over the distances of eye and vertex. Light goes that way where T is phi, the angle between eye
// and vertex, or 2 PI - phi, or 2 PI + phi. Each asin(k sin t) with k < 1 is concave in t, so T is convex: it meets an
// angle twice at most, where it falls and where it rises, and only once where it begins to rise at once.

const int MOST_CHORDS = 2;
const float FLAT = 0.05;     // least |dT/dt| of a link: where the image is folded, paths from the camera do as well
const float GRAZING = 0.999; // largest sine of the angle of incidence
const int ROUNDS = 12;       // of the search of a root, at most
const float CLOSE = 2e-5;    // radians: a step of Newton's method further, T is met as closely as floats allow

// What a sphere has of links.
struct Arc {
    vec3 to_eye;     // unit, from the centre
    vec3 to_vertex;  // unit, from the centre
    vec3 ratios;     // sines at the eye, at the vertex and inside, over that of the angle of incidence
    float radius;
    float cosine;    // of phi
    float sine;
    float angle;     // phi
    int chords;
};

Arc arc_of(vec3 eye, vec3 vertex, Sphere sphere, float ior, int chords) {
    precise vec3 u = eye - sphere.center;
    precise vec3 v = vertex - sphere.center;
    precise float eye_distance = length(u);
    precise float vertex_distance = length(v);
    precise vec3 to_eye = u / eye_distance;
    precise vec3 to_vertex = v / vertex_distance;
    precise float cosine = dot(to_eye, to_vertex);
    precise float sine = length(cross(to_eye, to_vertex));
    precise vec3 ratios = vec3(sphere.radius / eye_distance, sphere.radius / vertex_distance, 1.0 / ior);
    if (chords == 0) ratios.z = 0.0;
    return Arc(to_eye, to_vertex, ratios, sphere.radius, cosine, sine, angle_of(sine, cosine), chords);
}

// Whether eye and vertex lie outside the sphere, not in line with its centre.
bool has_links(Arc arc) {
    return arc.ratios.x < 1.0 && arc.ratios.y < 1.0 && arc.sine > 0.0;
}

float cosine_of(float sine) {
    precise float cosine = sqrt(max((1.0 - sine) * (1.0 + sine), 0.0));
    return cosine;
}

// Cosines where the way meets the eye, the vertex, and the sphere from inside.
vec3 cosines_along(Arc arc, float sine) {
    precise vec3 s = arc.ratios * sine;
    precise vec3 cosines = sqrt(max((1.0 - s) * (1.0 + s), 0.0));
    return cosines;
}

// dT / dt.
float slope_of(Arc arc, vec3 cosines, float cosine) {
    precise vec3 each = arc.ratios / cosines;
    precise float slope = 2.0 - cosine * (each.x + each.y + 2.0 * float(arc.chords) * each.z);
    return slope;
}

// An angle of incidence, by the tangent of its half.
struct Incidence {
    float half_tangent;
    float sine;
    float cosine;
};

Incidence incidence_of(float half_tangent) {
    precise float square = half_tangent * half_tangent;
    precise float sine = 2.0 * half_tangent / (1.0 + square);
    precise float cosine = (1.0 - square) / (1.0 + square);
    return Incidence(half_tangent, sine, cosine);
}

// T.
float turn_of(Arc arc, Incidence at, vec3 cosines) {
    precise float turn = 4.0 * small_angle(at.half_tangent);
    turn -= angle_of(arc.ratios.x * at.sine, cosines.x);
    turn -= angle_of(arc.ratios.y * at.sine, cosines.y);
    if (arc.chords > 0) turn += float(arc.chords) * (PI - 2.0 * angle_of(arc.ratios.z * at.sine, cosines.z));
    return turn;
}

// The ways of a sphere: of each angle that T may meet where it rises, then of those where it falls, which begin at
// chords * PI.
int way_count(int chords) { return 2 * chords + 1; }
bool way_falls(int chords, int way) { return way > chords; }
int lap_of(int chords, int way) { return way_falls(chords, way) ? way - chords - 1 : way; }

// phi, 2 PI - phi, 2 PI + phi: the way runs about the centre from the eye towards the vertex in even laps, and the
// other way round in the odd one.
float lap_sense(int lap) { return lap == 1 ? -1.0 : 1.0; }
float angle_of_lap(Arc arc, int lap) {
    precise float angle = lap_sense(lap) * arc.angle + (lap == 0 ? 0.0 : 2.0 * PI);
    return angle;
}

// Whether T may meet the angle: where it rises it must end above it, where it falls begin above it.
bool may_meet(Arc arc, float angle, bool falls) {
    bool begins_to_fall = 2.0 - arc.ratios.x - arc.ratios.y - 2.0 * float(arc.chords) * arc.ratios.z < 0.0;
    if (falls) return begins_to_fall;
    if (!begins_to_fall && angle < float(arc.chords) * PI) return false;
    Incidence grazing = incidence_of(1.0);
    return turn_of(arc, grazing, cosines_along(arc, 1.0)) >= angle;
}

// The half tangent where T meets an angle; -1: nowhere. Newton's method from the end of the convex curve, held
// between bounds.
float meeting_of(Arc arc, float angle, bool falls) {
    precise float low = 0.0;
    precise float high = 1.0;
    precise float m = falls ? 0.0 : 1.0;
    float found = -1.0;
    for (int i = 0; i < ROUNDS && found < 0.0; ++i) {
        precise Incidence at = incidence_of(m);
        precise vec3 cosines = cosines_along(arc, at.sine);
        precise float miss = turn_of(arc, at, cosines) - angle;
        precise float slope = slope_of(arc, cosines, at.cosine);
        bool is_below = falls ? slope < 0.0 && miss > 0.0 : slope <= 0.0 || miss <= 0.0;
        if (is_below) low = m;
        else high = m;
        precise float next = m - miss * 0.5 * (1.0 + m * m) / slope;
        bool is_close = abs(miss) < CLOSE && falls == slope < 0.0;
        m = next > low && next < high || is_close ? next : 0.5 * (low + high);
        if (is_close) found = clamp(m, 0.0, 1.0);
    }
    return found;
}

// Solid angle at the eye over area at the vertex, across the ray; 0: no link.
float spread_of(Arc arc, float sine) {
    if (sine >= GRAZING || !has_links(arc)) return 0.0;
    precise float cosine = cosine_of(sine);
    precise vec3 cosines = cosines_along(arc, sine);
    precise float slope = abs(slope_of(arc, cosines, cosine));
    if (slope < FLAT) return 0.0;
    precise vec2 k = arc.ratios.xy;
    precise float across = k.x * k.x * k.y * k.y / (arc.radius * arc.radius);
    precise float spread = across * sine * cosine / (cosines.x * cosines.y * arc.sine * slope);
    return spread;
}

// How likely a path that meets the sphere goes this way: Fresnel's share at each surface.
float chance_of(Material material, float sine, int chords) {
    if (!(HAS_DIELECTRIC && material.kind == DIELECTRIC)) return 1.0;
    precise float reflected = fresnel(cosine_of(sine), 1.0 / material.ior);
    precise float passed = (1.0 - reflected) * (1.0 - reflected);
    precise float chance = chords == 0 ? reflected : chords == 1 ? passed : passed * reflected;
    return chance;
}

// What is left of light on this way, beside its chance: the colour of a mirror, or what glass does not absorb.
vec3 tint_of(Material material, Arc arc, Incidence at) {
    if (!(HAS_DIELECTRIC && material.kind == DIELECTRIC)) return metal_reflectance(material, at.cosine);
    precise float chord = 2.0 * arc.radius * cosine_of(arc.ratios.z * at.sine);
    return HAS_ATTENUATION ? share_left(absorption_of_glass(material.details), float(arc.chords) * chord) : vec3(1.0);
}

// The share of the links tried that are of one sphere and so many chords.
float link_share(Material material, int chords) {
    precise float share = 1.0 / float(bitCount(LINKED));
    if (!(HAS_DIELECTRIC && material.kind == DIELECTRIC)) return share;
    return chords == 1 ? 0.5 * share : 0.25 * share;
}

// --- the camera's side -----------------------------------------------------------------------

// What a path from the camera has met before the first vertex that is no delta.
struct Chain {
    int state;
    int sphere;
    int chords;
    float sine;  // of the angle of incidence
    vec3 eye;
    float film;  // density of the ray from the camera, per solid angle
};

const int UNBROKEN = 0;  // no vertex yet
const int INSIDE = 1;    // a ball
const int LINKING = 2;   // one sphere lies behind, as particles are linked through it
const int BROKEN = 3;    // as none are; or the chain has ended

Chain start_chain(Ray ray) {
    return Chain(UNBROKEN, NO_SHAPE, 0, 0.0, ray.origin, LINKED != 0 ? pdf_camera(ray.direction) : 0.0);
}

bool is_linked(int shape) { return shape < sphere_count() && shape < 31 && (LINKED >> shape & 1) != 0; }

// After scattering. `is_outside`: whether it was met from outside.
void follow_chain(precise inout Chain chain, int shape, Vertex vertex, bool crosses) {
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

// What particles that are linked through a sphere are weighed against, at a vertex with this cosine.
float rho_of_link(Chain chain, vec3 position, float cosine) {
    if (chain.state != LINKING) return 0.0;
    precise Sphere sphere = sphere_at(chain.sphere);
    precise Material material = material_at(sphere.material);
    precise Arc arc = arc_of(chain.eye, position, sphere, material.ior, chain.chords);
    precise float pdf = chain.film * cosine * spread_of(arc, chain.sine) * chance_of(material, chain.sine, chain.chords);
    precise float rho = pdf / (frame.particles * frame.linked * link_share(material, chain.chords));
    return rho;
}
