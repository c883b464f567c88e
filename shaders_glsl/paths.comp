// Traces samples of one pixel again, with the code of paths and the random numbers of trace.comp. It writes down each
// vertex of their paths and each light that they find. OF_PARTICLES: it traces the particles that reach the pixel, as
// particles.comp does. Records come in any order, and each contains its place.

layout(local_size_x = 32) in;

#include "structs/path_records.glsl"
#include "integrators/record_numbers.glsl"

layout(std430) buffer Replay {
    ivec2 place;         // of the pixel in the full frame
    uint vertices_seen;   // number of records; only the first `most` of them are written
    uint lights_seen;
    uint most_vertices;  // 0: none are wanted
    uint most_lights;
    int first_lane;      // first lane of the particles that are followed
    int end_lane;
    SampleRecord samples[];
};
layout(std430) writeonly buffer Vertices { VertexRecord vertices[]; };
layout(std430) writeonly buffer Lights { LightRecord lights[]; };
layout(std430) buffer Lost { uint lost_samples; };  // as in trace.comp

// Records of the vertex that the path has reached, and of the light that it finds next.
VertexRecord here = VertexRecord(
    vec3(0.0), 0, vec3(0.0), 0, vec3(0.0), 0, vec3(0.0), EVENT_ENDED, vec3(0.0), 0.0, 0.0, 1.0, 0, 0);
LightRecord light_here = LightRecord(vec3(0.0), 0, vec3(0.0), 0, 0, 0, 0, 0, 0.0, 0.0, 1.0, 0.0, vec3(0.0), 0);
int vertex_number = -1;
int light_number = 0;
int end_reason = END_CUT_LOOP;

void write_vertex() {
    if (vertex_number < 0 || most_vertices == 0u) return;
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
    begin_light();  // emission there is not gathered
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

// Light of radiance 0 is not written down, nor a sample of density 0.
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
        uint row = most_lights > 0u ? atomicAdd(lights_seen, 1u) : 0u;
        if (row < most_lights) lights[row] = light_here;
    }
    begin_light();
}

void record_link(vec3 radiance, float pdf, float other_pdf, float weight) {
    light_here.radiance = radiance;
    light_here.pdf = pdf;
    record_weight(other_pdf, weight);
}

void record_end(int reason) { end_reason = reason; }

#include "trace.glsl"

const int PARTICLE_GROUP = 64;  // particles, as in particles.comp

int lamp = 0;  // object that the particle comes from

// Adds this pixel's share of the light that a particle brings to the frame: a mean over the particles of a sample.
void splat(vec2 film, vec3 radiance, int layer) {
    if (ivec2(floor(film)) != place) {
        begin_light();
        return;
    }
    vec3 added = radiance / frame.particles;
    record_light(BY_PARTICLE, lamp, light_here.pdf, light_here.radiance, added);
}

#include "integrators/particle_start.glsl"
#include "integrators/camera_links.glsl"
#include "integrators/light_links.glsl"
#include "integrators/particles.glsl"

vec3 lamp_normal(Light light, vec3 position) {
    if (is_sphere_lamp(light.shape)) {
        Sphere sphere = sphere_at(light.shape);
        vec3 normal = (position - sphere.center) / sphere.radius;
        return normal;
    }
    if (is_triangle_lamp(light.shape)) return normalized(lamp_triangle(light.shape).across);
    if (is_disk_lamp(light.shape)) return disk_lamp(light.shape).normal;
    if (is_quad_lamp(light.shape)) return quad_lamp(light.shape).normal;
    return vec3(0.0);
}

// One particle of the sample first_sample.
void replay_particle() {
    int lane = first_lane + int(gl_GlobalInvocationID.x);
    if (lane >= end_lane) return;
    here.sample_index = frame.first_sample;
    light_here.sample_index = frame.first_sample;
    light_here.lane = lane;
    Sampler rng = sampler_at(ivec2(lane, -1), frame.first_sample, frame.seed);
    Particle particle = start_particle(rng);
    Ray ray = particle.path.ray;
    vec3 normal = ray.direction;
    lamp = is_from_sky(particle.light) ? FROM_BACKGROUND : FROM_SUN;
    if (particle.light >= 0) {
        normal = lamp_normal(light_at(particle.light), ray.origin);
        lamp = object_number(light_at(particle.light).shape);
    }
    record_vertex(ray.origin, normal, normal, lamp, 0.0, particle.path.throughput);
    here.event = EVENT_SENT;
    here.direction = ray.direction;
    here.pdf = particle.emission;
    bool is_linked = lane / PARTICLE_GROUP < frame.linked_groups;
    Sampler of_links = rng;
    if (LINKS_LIGHTS) link_light(particle, is_linked, of_links);
    if (particle.power != vec3(0.0)) while (extend_particle(particle, is_linked, rng)) {}
    write_vertex();
    if (loop_was_cut) atomicAdd(lost_samples, 1u);
}

void replay_sample() {
    int offset = int(gl_GlobalInvocationID.x);
    if (offset >= frame.sample_count) return;
    int index = frame.first_sample + offset;
    here.sample_index = index;
    light_here.sample_index = index;
    Sampler rng = sampler_at(place, index, frame.seed);
    Path path = camera_path(place, rng);
    record_vertex(path.ray.origin, frame.camera.forward, frame.camera.forward, NO_SHAPE, 0.0, path.throughput);
    here.event = EVENT_SENT;
    here.direction = path.ray.direction;
    while (extend_path(path, rng)) {}
    write_vertex();
    if (loop_was_cut) atomicAdd(lost_samples, 1u);
    samples[offset] = SampleRecord(path.radiance, loop_was_cut ? END_CUT_LOOP : end_reason);
}

void main() {
    if (OF_PARTICLES) replay_particle();
    else replay_sample();
}
