// Where compute kernels keep the scene. The path text knows only the functions below.

layout(std140) uniform FrameBlock { Frame frame; };
layout(std430) readonly buffer Spheres { Sphere spheres[]; };
layout(std430) readonly buffer Planes { Plane planes[]; };
layout(std430) readonly buffer Quads { Quad quads[]; };
layout(std430) readonly buffer Nodes { Node nodes[]; };
layout(std430) readonly buffer Materials { Material materials[]; };
layout(std430) readonly buffer Lights { Light lights[]; };
layout(std430) readonly buffer Clusters { Cluster clusters[]; };

Sphere sphere_at(int index) { return spheres[index]; }
Plane plane_at(int index) { return planes[index]; }
Quad quad_at(int index) { return quads[index]; }
Node node_at(int index) { return nodes[index]; }
Material material_at(int index) { return materials[index]; }
Light light_at(int index) { return lights[index]; }
Cluster cluster_at(int index) { return clusters[index]; }

int sphere_count() { return frame.sphere_count; }
int plane_count() { return frame.plane_count; }
int quad_count() { return frame.quad_count; }
int node_count() { return frame.node_count; }
int light_count() { return frame.light_count; }
