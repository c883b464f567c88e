// Resampled importance sampling (Talbot et al., EGSR 2005) and reservoirs (Bitterli et al., "Spatiotemporal Reservoir
// Resampling", SIGGRAPH 2020). Candidates y_i have the weights w_i = m_i p(y_i) / (density of y_i). One of them is kept
// with a chance in proportion to its weight. The target p is not a density: it is the luminance of the light that y
// would bring to a surface, over albedo / PI. With W = sum(w_i) / p(y), the mean of f(y) W is the integral of f.
//
// Densities are per area, so that other surfaces can use a candidate unchanged.

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);  // of linear sRGB, Rec. 709

float luminance(vec3 light) {
    float value = dot(light, LUMINANCE);
    return value;
}

// A point that sends the same light to all surfaces before it.
struct Source {
    vec3 position;
    vec3 normal;  // unit, on the side that shines
    vec3 light;   // radiance
    int shape;
};

// A matte surface that is lit.
struct Receiver {
    vec3 position;
    vec3 normal;   // unit, towards where the path came from
    int shape;     // NO_SHAPE: no surface
    bool is_within;  // whether the lit side is the inside of the shape
};

struct Reservoir {
    Source kept;
    float weight;  // W, per area
    float count;   // number of candidates seen, in units of the candidates of one sample
    Receiver at;
};

Source no_source() {
    return Source(vec3(0.0), vec3(0.0), vec3(0.0), NO_SHAPE);
}

Receiver no_receiver() {
    return Receiver(vec3(0.0), vec3(0.0), NO_SHAPE, false);
}

Reservoir empty_reservoir() {
    return Reservoir(no_source(), 0.0, 0.0, no_receiver());
}

// cos cos / r^2 between a surface and a source; 0 where one is behind the other.
float geometry_term(Receiver at, Source source) {
    vec3 away = source.position - at.position;
    float distance = length(away);
    if (distance == 0.0) return 0.0;
    vec3 direction = away / distance;
    float cos_here = dot(at.normal, direction) / distance;
    float cos_there = -dot(source.normal, direction) / distance;
    if (cos_here <= 0.0 || cos_there <= 0.0) return 0.0;
    float product = cos_here * cos_there;
    return product;
}

// The target of a source, if nothing stands between.
float target(Receiver at, Source source) {
    float value = geometry_term(at, source) * luminance(source.light);
    return value;
}

// Candidates one after the other: the sum of their weights, and the candidate that is kept.
struct Stream {
    float sum;
    Source kept;
    int origin;  // the number of the candidate that is kept
};

Stream empty_stream() {
    return Stream(0.0, no_source(), 0);
}

// `u`: a uniform random number, used for this candidate alone.
void offer(inout Stream stream, Source source, float weight, int origin, float u) {
    stream.sum += weight;
    if (u * stream.sum < weight) {
        stream.kept = source;
        stream.origin = origin;
    }
}

// Layout of reservoirs in a texture: each pixel has a block of so many texels.
const int ROWS_OF_RESERVOIR = 2;
const int COLUMNS_OF_RESERVOIR = 3;
const int PARTS_OF_RESERVOIR = ROWS_OF_RESERVOIR * COLUMNS_OF_RESERVOIR;

ivec2 texel_of_part(ivec2 pixel, int part) {
    ivec2 place = ivec2(part % COLUMNS_OF_RESERVOIR, part / COLUMNS_OF_RESERVOIR);
    return ivec2(COLUMNS_OF_RESERVOIR, ROWS_OF_RESERVOIR) * pixel + place;
}

// The number of a shape as two halves, which a float holds exactly for every number.
vec2 halves_of(int shape) {
    return vec2(float(shape & 0xFFFF), float(shape >> 16));
}

int of_halves(vec2 halves) {
    return int(halves.y) << 16 | int(halves.x);
}

vec4 part_of_reservoir(Reservoir held, int part) {
    if (part == 0) return vec4(held.kept.position, held.weight);
    if (part == 1) return vec4(held.kept.normal, held.count);
    if (part == 2) return vec4(held.kept.light, held.at.is_within ? 1.0 : 0.0);
    if (part == 3) return vec4(held.at.position, 0.0);
    if (part == 4) return vec4(held.at.normal, 0.0);
    return vec4(halves_of(held.kept.shape), halves_of(held.at.shape));
}

Reservoir reservoir_of_pixel(ivec2 pixel) {
    vec4 a = reservoir_part_at(texel_of_part(pixel, 0));
    vec4 b = reservoir_part_at(texel_of_part(pixel, 1));
    vec4 c = reservoir_part_at(texel_of_part(pixel, 2));
    vec4 d = reservoir_part_at(texel_of_part(pixel, 3));
    vec4 e = reservoir_part_at(texel_of_part(pixel, 4));
    vec4 f = reservoir_part_at(texel_of_part(pixel, 5));
    Source kept = Source(a.xyz, b.xyz, c.xyz, of_halves(f.xy));
    return Reservoir(kept, a.w, b.w, Receiver(d.xyz, e.xyz, of_halves(f.zw), c.w != 0.0));
}
