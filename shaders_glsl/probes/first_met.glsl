// Events that a path reports on its way. Here it starts at a probe, and the first surface that it meets is kept.

vec3 met_normal = vec3(0.0);
int met_object = -1;
float met_distance = 0.0;
bool has_met = false;
bool has_left = false;  // the path has left that surface

void record_vertex(vec3 position, vec3 normal, vec3 shading_normal, int object, float distance, vec3 throughput) {
    if (has_met) return;
    met_normal = normal;
    met_object = object;
    met_distance += distance;
    has_met = true;
}

void record_scattering(vec3 shading_normal, vec3 direction, float pdf, bool crosses) { has_left = true; }

// The path goes on in its direction: the surface that it has just met does not count as the first.
void record_passing(int event) { has_met = has_left; }

// The rest is as in integrators/no_record.glsl.
void record_survival(float survival) {}
void record_weight(float other_pdf, float weight) {}
void record_shadow() {}
void record_link(vec3 radiance, float pdf, float other_pdf, float weight) {}
void record_sample(vec3 direction, float distance) {}
void record_light(int strategy, int object, float pdf, vec3 radiance, vec3 added) {}
void record_end(int reason) {}
