// Records of a replay of single paths: paths.comp writes them, and glrt/rendering/paths/records.py reads them.
// Positions are relative to the camera; objects have the kernel's numbers.

struct SampleRecord {
    vec3 radiance;
    int end;  // why the path ended
};

struct VertexRecord {
    vec3 position;
    int sample_index;
    vec3 normal;  // of the shape: outward on a shape with an inside
    int vertex;   // its number on the path, from 0, the camera
    vec3 shading_normal;
    int object;
    vec3 throughput;  // up to the vertex, with scale and the absorption in glass on the way
    int event;
    vec3 direction;  // in which the path leaves the vertex; 0: none
    float pdf;       // of that direction per solid angle; 0: a delta
    float way;       // distance from the vertex before
    float survival;  // the chance that roulette gave the path there
    int spare_a;     // fill the row
    int spare_b;
};

struct LightRecord {
    vec3 radiance;  // emission at the source
    int sample_index;
    vec3 added;     // added to the radiance of the sample
    int number;     // of the light on the path, from 0
    int vertex;     // last vertex on the path before the light was added
    int strategy;
    int object;     // or FROM_BACKGROUND or FROM_SUN
    int is_hidden;  // 1: hidden from the vertex where it was sampled
    float pdf;        // density with which it was found, per solid angle; 0: by a delta, or seen by the camera
    float other_pdf;  // density of the other strategy for it; 0: that cannot find it, or is not asked
    float weight;
    float distance;   // of the sampled point from the vertex; 0: nothing was sampled
    vec3 direction;   // towards the sampled point, unit
    int lane;         // of a particle: its number among the particles of its sample
};
