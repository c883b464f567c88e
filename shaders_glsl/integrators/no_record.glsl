// Events that a path reports on its way. The functions of paths.comp write them down; here they do nothing, and the
// compiler removes them. Directions and normals are unit vectors of the world, positions relative to the camera.

// The path has met a surface after `distance`. `throughput` contains the absorption of the way there, and scale.
// `object` is the kernel's number of an object of the scene.
void record_vertex(vec3 position, vec3 normal, vec3 shading_normal, int object, float distance, vec3 throughput) {}

// The path scatters there; `pdf` is the density per solid angle, 0: a delta.
void record_scattering(vec3 shading_normal, vec3 direction, float pdf, bool crosses) {}

// The path goes on there in its direction.
void record_passing(int event) {}

// The chance to go on that roulette gave the path.
void record_survival(float survival) {}

// About the light that is recorded next: the density of the other strategy, and the weight of this one.
void record_weight(float other_pdf, float weight) {}

// The light that is recorded next is hidden from the surface where it was sampled.
void record_shadow() {}

// A particle is linked to the camera there: the emission that it brings, its density, that of a path from the camera,
// and its weight.
void record_link(vec3 radiance, float pdf, float other_pdf, float weight) {}

// The light that is recorded next was sampled at `distance` in this direction.
void record_sample(vec3 direction, float distance) {}

// Light was found with the density `pdf`: `radiance` is the emission there, `added` the value that the pixel gets.
void record_light(int strategy, int object, float pdf, vec3 radiance, vec3 added) {}

// The path ends.
void record_end(int reason) {}
