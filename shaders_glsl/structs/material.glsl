// Materials. Colours are linear sRGB.

const int MATTE = 0;       // Lambert's law; lamps are of this kind too
const int METAL = 1;       // mirror or GGX
const int DIELECTRIC = 2;  // smooth interface with Fresnel reflection

struct Material {
    vec3 color;      // albedo or reflectance; of a conductor, a factor of it
    int kind;        // MATTE, METAL or DIELECTRIC
    vec3 emission;   // radiance, light intensity included
    float alpha;     // GGX roughness, the square of the scene file's; 0: mirror
    float ior;       // inside over outside
    int layer;       // of its light group, where light is kept by layers
    int emitter;     // how it emits: index into the emitters
    int conductor;   // index into the conductors, or NO_CONDUCTOR
};

// How lamps emit that do not so evenly and to both sides.
struct Emitter {
    vec3 axis;         // unit; v is 1 - cos of the angle to it
    float outer;       // v from which on nothing is emitted
    float slope;       // 1 over the length of v over which the emission falls
    int is_one_sided;  // whether it emits from its front alone
};
