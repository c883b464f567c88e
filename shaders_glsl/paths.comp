// Traces samples of one pixel again, by the path text and the random numbers of trace.comp, and writes down each
// vertex of their paths and each light that they find. Records come in any order: each tells its place.

layout(local_size_x = 32) in;

#include "structs/path_records.glsl"
#include "integrators/record_numbers.glsl"

layout(std430) buffer Replay {
    ivec2 place;         // of the pixel in the full frame
    uint vertices_seen;   // records that there are, more than `most` of them are not written
    uint lights_seen;
    uint most_vertices;  // 0: none is wanted
    uint most_lights;
    uint spare_a;        // fill the row
    uint spare_b;
    SampleRecord samples[];
};
layout(std430) writeonly buffer Vertices { VertexRecord vertices[]; };
layout(std430) writeonly buffer Lights { LightRecord lights[]; };
layout(std430) buffer Lost { uint lost_samples; };  // as in trace.comp

// Of the vertex that the path is at, and of the light that it finds next.
precise VertexRecord here = VertexRecord(
    vec3(0.0), 0, vec3(0.0), 0, vec3(0.0), 0, vec3(0.0), EVENT_ENDED, vec3(0.0), 0.0, 0.0, 1.0, 0, 0);
precise LightRecord light_here = LightRecord(vec3(0.0), 0, vec3(0.0), 0, 0, 0, 0, 0, 0.0, 0.0, 1.0, 0.0, vec3(0.0), 0);
int vertex_number = -1;
int light_number = 0;
int end_reason = END_CUT_LOOP;

void write_vertex() {
    if (vertex_number < 0) return;
    uint row = atomicAdd(vertices_seen, 1u);
    if (row < most_vertices) vertices[row] = here;
}

void begin_light() {
    light_here.other_pdf = 0.0;
    light_here.weight = 1.0;
    light_here.is_hidden = 0;
    light_here.distance = 0.0;
    light_here.direction = vec3(0.0);
}

void record_vertex(vec3 position, vec3 normal, vec3 shading_normal, int object, float way, vec3 throughput) {
    write_vertex();
    vertex_number += 1;
    here.position = position;
    here.normal = normal;
    here.shading_normal = shading_normal;
    here.vertex = vertex_number;
    here.object = object;
    here.throughput = throughput;
    here.event = EVENT_ENDED;
    here.direction = vec3(0.0);
    here.pdf = 0.0;
    here.way = way;
    here.survival = 1.0;
}

void record_scattering(vec3 shading_normal, vec3 direction, float pdf, bool crosses) {
    here.shading_normal = shading_normal;
    here.direction = direction;
    here.pdf = pdf;
    here.event = crosses ? EVENT_CROSSED : EVENT_REFLECTED;
}

void record_passing(int event) {
    here.event = event;
    begin_light();  // what shines there is not gathered
}

void record_survival(float survival) { here.survival = survival; }

void record_weight(float other_pdf, float weight) {
    light_here.other_pdf = other_pdf;
    light_here.weight = weight;
}

void record_shadow() { light_here.is_hidden = 1; }

void record_sample(vec3 direction, float distance) {
    light_here.direction = direction;
    light_here.distance = distance;
}

// What is dark is not written down, nor where nothing was sampled.
void record_light(int strategy, int object, float pdf, vec3 radiance, vec3 added) {
    bool is_nothing = strategy == BY_SAMPLING && pdf == 0.0;
    if (radiance != vec3(0.0) && !is_nothing) {
        light_here.radiance = radiance;
        light_here.added = added;
        light_here.number = light_number;
        light_here.vertex = vertex_number;
        light_here.strategy = strategy;
        light_here.object = object;
        light_here.pdf = pdf;
        light_number += 1;
        uint row = atomicAdd(lights_seen, 1u);
        if (row < most_lights) lights[row] = light_here;
    }
    begin_light();
}

bool goes_on(int reason) {
    end_reason = reason;
    return false;
}

#include "trace.glsl"

void main() {
    int offset = int(gl_GlobalInvocationID.x);
    if (offset >= frame.sample_count) return;
    int index = frame.first_sample + offset;
    here.sample_index = index;
    light_here.sample_index = index;
    precise Sampler rng = sampler_at(place, index, frame.seed);
    precise Path path = camera_path(place, rng);
    record_vertex(path.ray.origin, frame.camera.forward, frame.camera.forward, NO_SHAPE, 0.0, path.throughput);
    here.event = EVENT_SENT;
    here.direction = path.ray.direction;
    while (extend_path(path, rng)) {}
    write_vertex();
    if (loop_was_cut) atomicAdd(lost_samples, 1u);
    samples[offset] = SampleRecord(path.radiance, loop_was_cut ? END_CUT_LOOP : end_reason);
}
