// What a path tells on its way. paths.comp has these functions write it down; here they do nothing, and the compiler
// leaves nothing of them. Directions and normals are unit vectors of the world, positions relative to the camera.

// The path has met a surface after `distance`; `throughput` has what the way there absorbed, and scale. `object` is
// the kernel's number of an object of the scene.
void record_vertex(vec3 position, vec3 normal, vec3 shading_normal, int object, float distance, vec3 throughput) {}

// It scatters there; `pdf` is the density per solid angle, 0: a delta.
void record_scattering(vec3 shading_normal, vec3 direction, float pdf, bool crosses) {}

// It goes on there as it came.
void record_passing(int event) {}

// The chance to go on that roulette gave it.
void record_survival(float survival) {}

// Of the light that is recorded next: the density of the other strategy, and the weight of this one.
void record_weight(float other_pdf, float weight) {}

// The light that is recorded next is hidden from where it was sampled.
void record_shadow() {}

// A particle is linked to the camera there: its density, that of a path from the camera, and its weight.
void record_link(float pdf, float other_pdf, float weight) {}

// The light that is recorded next was sampled so far away in this direction.
void record_sample(vec3 direction, float distance) {}

// Light was found with the density `pdf`: `radiance` is what shines there, `added` what the pixel gets.
void record_light(int strategy, int object, float pdf, vec3 radiance, vec3 added) {}

// The path ends.
void record_end(int reason) {}
