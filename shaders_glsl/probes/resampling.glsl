// Method resampled: light at the first matte surface of a path comes from one point, which is kept out of several
// candidates. These are a point on a lamp and the surface that a scattered ray meets, a lamp or a matte surface. The
// light of a matte surface is its own direct light and that of probes (Majercik et al., "Dynamic Diffuse Global
// Illumination Resampling", 2022). REUSES_OWN: the point that the sample before kept for this pixel is a candidate,
// too; REUSES_NEAR: how many pixels around are asked. All reuse is of one frame before, so that a sample is one
// dispatch (Wyman and Panteleev, "Rearchitecting Spatiotemporal Resampling for Production", HPG 2021).
//
// Some light is no candidate: light from the sky and the sun, from lamps with cones or one side, and from surfaces that
// a scattered ray meets and that are not matte. Paths add it by `gather`, as they do without resampling.

const int MOST_COUNTED = 20;         // most candidates that one reservoir stands for
const float NEAR_PART = 1.0 / 48.0;  // of the height of the frame: how far away pixels around lie at most
const float LEAST_ALIKE = 0.9063;    // least cosine between normals of pixels that are asked: 25 degrees
const float NEXT_TO_SOURCE = 1.0 / 1024.0;  // of the way to a source: its own object this near hides none
const float MOST_DEEPER = 0.1;       // most relative difference of the pixels' distances from the camera
const int STREAMS = 1 + (REUSES_OWN ? 1 : 0) + REUSES_NEAR;
const bool REUSES = REUSES_OWN || REUSES_NEAR > 0;
const bool RESAMPLES_LAMPS = RESAMPLES && !IS_AIMED;

const int BEFORE_FIRST = 0;   // the path has not met its first matte surface
const int SCATTERED = 1;      // it has left that surface
const int BEYOND_SECOND = 2;  // it has then met another matte surface and gathers the light of that
const int GATHERS_ALONE = 3;  // it has then met something else

// State of the resampling of one sample.
struct Resampling {
    int stage;
    Receiver at;
    vec3 factor;   // of the light that the surface sends on: the path's throughput with scale, times albedo / PI
    Stream stream;
    Source second; // the second matte surface, without its light
    vec3 earlier;  // radiance that the path gathered before that surface
    Sampler rng;   // of choices only, so that the path draws the same numbers as without resampling
};

Resampling resampling;
Reservoir held_reservoir;  // the reservoir that this sample keeps for the next one

void start_resampling(Sampler rng) {
    if (!RESAMPLES) return;
    vec3 none = vec3(0.0);
    Resampling begun =
        Resampling(BEFORE_FIRST, no_receiver(), none, empty_stream(), no_source(), none, sampler_beside(rng, 0));
    resampling = begun;
}

// Whether resampling begins at this vertex. It does not inside glass that absorbs light: there, the light of a point
// depends on the distance.
bool begins_resampling(Path path, Material material) {
    bool is_clear = path.absorption == vec3(0.0) && path.counts == 0u;
    return RESAMPLES && resampling.stage == BEFORE_FIRST && material.kind == MATTE && is_clear;
}

void begin_resampling(Path path, Vertex vertex, Ray ray) {
    resampling.stage = SCATTERED;
    resampling.at = Receiver(ray.origin, vertex.frame[2], ray.origin_shape, ray.inward);
    vec3 factor = path.scale * path.throughput * (vertex.material.color / PI);
    resampling.factor = factor;
}

void offer_source(Source source, float weight) {
    offer(resampling.stream, source, weight, 0, next_independent(resampling.rng));
}

// Offers a point on a lamp, by its density per solid angle; `facing`: the true normal on the side of wo.
void offer_lamp(LightSample light, vec3 facing) {
    if (light.pdf == 0.0) return;
    float cosine = dot(light.ray.direction, resampling.at.normal);
    if (cosine <= 0.0 || dot(light.ray.direction, facing) <= 0.0) return;
    if (occluded(light.ray, light.distance, light.shape)) return;
    Surface surface = surface_at(light.ray, Hit(light.distance, light.shape));
    vec3 normal = dot(surface.normal, light.ray.direction) < 0.0 ? surface.normal : -surface.normal;
    float share = power_heuristic(light.pdf, cosine / PI);
    float weight = share * luminance(light.radiance) * (cosine / light.pdf);
    offer_source(Source(surface.position, normal, light.radiance, light.shape), weight);
}

// The surface that the scattered ray of the first matte surface meets, as a source without light.
Source source_met(Path path, Surface surface) {
    vec3 normal = true_normal(surface);
    if (dot(normal, path.ray.direction) > 0.0) normal = -normal;
    return Source(surface.position, normal, vec3(0.0), surface.shape);
}

// Whether the emission of a surface that the path meets is a candidate. Otherwise the path gathers it.
bool is_candidate(vec3 emission) {
    return RESAMPLES_LAMPS && resampling.stage == SCATTERED && emission != vec3(0.0);
}

// Offers emission that scattering met. `share`: its weight against points sampled on lamps.
void offer_met(Path path, Surface surface, vec3 emission, float share) {
    Source source = source_met(path, surface);
    source.light = emission;
    offer_source(source, share * luminance(emission) * PI);
}

// From a second matte surface on, the path gathers the light of that surface alone.
void meet_second(inout Path path, Surface surface, Material material) {
    if (!RESAMPLES || resampling.stage != SCATTERED) return;
    resampling.stage = GATHERS_ALONE;
    if (material.kind != MATTE || path.depth == frame.bounces) return;
    resampling.stage = BEYOND_SECOND;
    resampling.second = source_met(path, surface);
    resampling.earlier = path.radiance;
    path.radiance = vec3(0.0);
    path.throughput = vec3(1.0);
    path.scale = 1.0;
}

// Whether two pixels show surfaces that are lit alike.
bool are_alike(Receiver one, Receiver other) {
    if (one.shape == NO_SHAPE || other.shape == NO_SHAPE) return false;
    if (object_number(one.shape) != object_number(other.shape) || one.is_within != other.is_within) return false;
    float near = length(one.position);
    float far = length(other.position);
    return dot(one.normal, other.normal) > LEAST_ALIKE && abs(near - far) < MOST_DEEPER * max(near, far);
}

// Whether something stands between a surface and a source before it. By rounding, the object of the source may be met
// next to the source; that hides nothing.
bool is_hidden(Receiver at, Source source) {
    vec3 away = source.position - at.position;
    float distance = length(away);
    Hit hit = closest_hit(Ray(at.position, away / distance, at.shape, at.is_within));
    if (hit.shape == NO_SHAPE || hit.distance >= distance) return false;
    bool is_there = object_number(hit.shape) == object_number(source.shape);
    return !is_there || hit.distance < distance * (1.0 - NEXT_TO_SOURCE);
}

// The pixel that a stream comes from; streams are numbered from 1 on.
ivec2 pixel_of_stream(ivec2 place, int stream) {
    if (REUSES_OWN && stream == 1) return place;
    int most = max(int(float(frame.size.y) * NEAR_PART), 1);
    Sampler rng = sampler_beside(resampling.rng, stream);
    float x = next_independent(rng);
    float y = next_independent(rng);
    return place + ivec2(floor(vec2(x, y) * float(2 * most + 1))) - most;
}

// The reservoir of a stream; its count is 0 where the stream has none to give.
Reservoir reservoir_of_stream(Receiver at, ivec2 place, int stream) {
    ivec2 pixel = pixel_of_stream(place, stream);
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, frame.size))) return empty_reservoir();
    Reservoir found = reservoir_of_pixel(pixel);
    if (!are_alike(at, found.at)) return empty_reservoir();
    found.count = min(found.count, float(MOST_COUNTED));
    return found;
}

// The share of a point that belongs to one stream and not to the sample's own. The stream has the target `there`, and
// the sample has `here`. The share is that of the stream if all `count` candidates were like its own; 0 where the
// stream does not see the point.
float share_of_stream(float count, float there, float here) {
    if (there == 0.0) return 0.0;
    float share = 1.0 / (1.0 + here / (count * there));
    return share;
}

// Merges the reservoirs of this sample and of the frame before into one. Each stream is weighed against the sample's
// own alone (pairwise weights: Bitterli, "Correlations and Reuse for Fast and Accurate Physically Based Light
// Transport", 2022). A stream with M_i of the M candidates of all streams has m_i = M_i / M share_i. The sample's own
// has the rest, m = sum_i(M_i / M (1 - share_i)). So no weight is far above the weights that it is made of. A stream
// that does not see the own point has no share of it. A ray tests this; the biased form sends none.
Reservoir merged(Reservoir own, ivec2 place) {
    float count = 0.0;
    for (int i = 1; i < STREAMS; i += 1) count += reservoir_of_stream(own.at, place, i).count;
    if (count == 0.0) return own;
    float here = target(own.at, own.kept);
    float left = 0.0;  // m of the own point
    Stream stream = empty_stream();
    for (int i = 1; i < STREAMS; i += 1) {
        Reservoir found = reservoir_of_stream(own.at, place, i);
        if (found.count == 0.0) continue;
        float part = found.count / count;
        float there = own.weight == 0.0 ? 0.0 : target(found.at, own.kept);
        if (UNBIASED && there > 0.0) {
            if (is_hidden(found.at, own.kept)) there = 0.0;
        }
        left += part * (1.0 - share_of_stream(count, there, here));
        float brought = found.weight == 0.0 ? 0.0 : target(own.at, found.kept);
        float share = share_of_stream(count, target(found.at, found.kept), brought);
        float u = next_independent(resampling.rng);
        offer(stream, found.kept, part * share * brought * found.weight, i, u);
    }
    float u = next_independent(resampling.rng);
    offer(stream, own.kept, left * here * own.weight, 0, u);
    Reservoir result = Reservoir(stream.kept, 0.0, 1.0 + count, own.at);
    if (stream.sum == 0.0) return result;
    if (stream.origin > 0) {
        if (is_hidden(own.at, stream.kept)) return result;
    }
    result.weight = stream.sum / target(own.at, stream.kept);
    return result;
}

// The end of a path: adds its light through the point that is kept.
void end_resampling(inout Path path, ivec2 place, int index) {
    if (!RESAMPLES) return;
    held_reservoir = empty_reservoir();
    if (resampling.stage == BEFORE_FIRST) return;
    if (resampling.stage == BEYOND_SECOND) {
        vec3 light = path.radiance;
        path.radiance = resampling.earlier;
        if (!is_finite(light)) path.radiance = light;
        else if (light != vec3(0.0)) {
            resampling.second.light = light;
            offer_source(resampling.second, luminance(light) * PI);
        }
    }
    Reservoir own = Reservoir(resampling.stream.kept, 0.0, 1.0, resampling.at);
    if (resampling.stream.sum > 0.0) own.weight = resampling.stream.sum / target(own.at, own.kept);
    Reservoir result = own;
    if (REUSES && index % BLOCK > 0) result = merged(own, place);
    held_reservoir = REUSES_OWN ? result : own;
    if (result.weight == 0.0) return;
    vec3 light = resampling.factor * result.kept.light * (geometry_term(result.at, result.kept) * result.weight);
    path.radiance += light;
}
