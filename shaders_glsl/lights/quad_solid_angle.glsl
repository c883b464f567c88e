// Points of a parallelogram, sampled nearly evenly in the solid angle that it fills, seen from near
// and from afar.
//
// The quad is cut into strips along its longer edge. Let x be across the strips, y along them and z the
// height of the point over the plane. The solid angle is |z| dx dy / r^3, r^2 = x^2 + y^2 + z^2. A
// strip is chosen evenly in the angle atan(x / z), and a point on it evenly in y / r, which is even in
// solid angle. So the density is 1 / (angle * extent). `extent` is the range of y / r over the strip, and
// no sample weighs more than 2 PI. The method of Urena et al. ("An Area-Preserving Parametrization for
// Spherical Rectangles", EGSR 2013) is even in x too, but it works only for rectangles. It also takes a
// sum of four angles less 2 PI, which has no digits for small lamps.

struct StripView {
    vec3 corner;  // from the point
    float z;      // height of the point over the plane, not below 0
    float x;      // of the corner
    float y;
};

StripView view_strips(Quad quad, vec3 origin) {
    vec3 corner = quad.corner - origin;
    float z = abs(dot(corner, quad.normal));
    float x = dot(corner, quad.dual_u) * quad.width;
    float y = dot(corner, quad.edge_v) / quad.height;
    return StripView(corner, z, x, y);
}

// Whether a point lies off the quad's plane.
bool is_beside(Quad quad, vec3 origin) {
    float z = dot(quad.corner - origin, quad.normal);
    return z * z > 0.0;
}

// The angle from x to x + width at the height z. A difference of the two angles would lose small ones.
float strip_angle(float x, float width, float z) {
    float end = x + width;
    float along = x * end + z * z;
    float both = sqrt((x * x + z * z) * (end * end + z * z));
    float half_angle = small_angle(z * width / (both + abs(along)));
    float angle = along >= 0.0 ? 2.0 * half_angle : PI - 2.0 * half_angle;
    return angle;
}

// The share of the width that belongs to the share u of the angle, both from the farther end.
float sample_strip(float x, float width, float z, float u) {
    float end = x + width;
    bool flip = x + end > 0.0;
    float far_end = flip ? -end : x;
    float turn = u * strip_angle(x, width, z);
    float s = sin(turn);
    float offset = s * (far_end * far_end + z * z) / (z * cos(turn) - far_end * s);
    float share = min(offset / width, 1.0);
    float from_corner = flip ? 1.0 - share : share;
    return from_corner;
}

// The ends of a strip at the distance d, from y to y + length; r^2 = d^2 + y^2.
struct StripEnds {
    vec2 sine;     // y / r
    vec2 cosine;   // d / r
    float extent;  // difference of the sines
};

StripEnds strip_ends(float y, float length, float d) {
    vec2 ends = vec2(y, y + length);
    vec2 inverse = 1.0 / sqrt(vec2(d * d) + ends * ends);
    vec2 sine = ends * inverse;
    vec2 cosine = d * inverse;
    float apart = sine.y - sine.x;  // a difference of nearly equal sines, if both are on one side
    float within = length * inverse.x * (abs(ends.x + ends.y) * inverse.y);
    float beside = cosine.x * cosine.y * within / (abs(sine.x) + abs(sine.y));
    return StripEnds(sine, cosine, ends.x < 0.0 && ends.y > 0.0 ? apart : beside);
}

// y, drawn evenly in y / r. The squared cosine is a sum of terms not below 0, with 1 - sine.x sine.y.
float sample_on_strip(StripEnds ends, float d, float u) {
    float v = 1.0 - u;
    float sine = v * ends.sine.x + u * ends.sine.y;
    vec2 square = ends.cosine * ends.cosine;
    float product = ends.sine.x * ends.sine.y;
    float beside = (square.x + square.y * (ends.sine.x * ends.sine.x)) / (1.0 + abs(product));
    float mixed = product < 0.0 ? 1.0 - product : beside;
    float cosine2 = v * v * square.x + u * u * square.y + 2.0 * u * v * mixed;
    float y = d * sine / sqrt(cosine2);
    return y;
}

// Distance of the point from the strip at the share `a` of edge_u.
float strip_distance(Quad quad, StripView view, float a) {
    float x = view.x + a * quad.width;
    float d = sqrt(x * x + view.z * view.z);
    return d;
}

// The density of the points of this strip, per solid angle.
float pdf_strips(Quad quad, StripView view, float a) {
    float d = strip_distance(quad, view, a);
    float y = view.y + a * quad.shear;
    float extent = strip_ends(y, quad.height, d).extent;
    float pdf = 1.0 / (strip_angle(view.x, quad.width, view.z) * extent);
    return pdf;
}

// A sampled point, as shares of edge_u and edge_v.
vec2 sample_strips(Quad quad, StripView view, vec2 u) {
    float a = sample_strip(view.x, quad.width, view.z, u.x);
    float d = strip_distance(quad, view, a);
    float y = view.y + a * quad.shear;
    float offset = sample_on_strip(strip_ends(y, quad.height, d), d, u.y) - y;
    float b = clamp(offset / quad.height, 0.0, 1.0);
    return vec2(a, b);
}
