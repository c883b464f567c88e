// What a replay of single paths writes down (paths.comp), as glrt/rendering/paths/records.py reads it. Positions are
// relative to the camera; objects have the kernel's numbers.

struct SampleRecord {
    vec3 radiance;
    int end;  // why the path ended
};

struct VertexRecord {
    vec3 position;
    int sample_index;
    vec3 normal;  // of the shape: outward on what has an inside
    int vertex;   // its number on the path, from 0, the camera
    vec3 shading_normal;
    int object;
    vec3 throughput;  // up to there, with scale and what glass on the way absorbed
    int event;
    vec3 direction;  // that the path takes from there; 0: none
    float pdf;       // of that direction per solid angle; 0: a delta
    float way;       // from the vertex before
    float survival;  // the chance that roulette gave the path there
    int spare_a;     // fill the row
    int spare_b;
};

struct LightRecord {
    vec3 radiance;  // that shines there
    int sample_index;
    vec3 added;     // to the radiance of the sample
    int number;     // of the light on the path, from 0
    int vertex;     // the last one on the path before it was added
    int strategy;
    int object;     // or FROM_BACKGROUND or FROM_SUN
    int is_hidden;  // from where it was sampled
    float pdf;        // with which it was found, per solid angle; 0: by a delta, or seen by the camera
    float other_pdf;  // with which the other strategy would have found it; 0: it could not, or is not asked
    float weight;
    float distance;   // of what was sampled, from the vertex; 0: nothing was
    vec3 direction;   // towards that, unit
    int lane;         // of a particle: its number among those of its sample
};
