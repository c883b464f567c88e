// Materials. Colours are linear sRGB.

const int MATTE = 0;       // Lambert's law; lamps are of this kind too
const int METAL = 1;       // mirror or GGX
const int DIELECTRIC = 2;  // interface with Fresnel reflection, smooth or GGX
const int PANE = 3;        // two smooth interfaces, so near each other that they are one surface
const int PRINCIPLED = 4;  // a coat over metal and dielectric facets over a matte base
const int NONE = 5;        // no surface: the bounds of a volume

struct Material {
    vec3 color;      // albedo or reflectance; for a conductor, a factor of its reflectance
    int kind;        // MATTE, METAL, DIELECTRIC, PANE, PRINCIPLED or NONE
    vec3 emission;   // radiance, light intensity included
    float alpha;     // GGX roughness, the square of the scene file's; 0: smooth
    float ior;       // inside over outside; of metal and principled surfaces: alpha along a direction over that across
    int layer;       // layer of its light group, where light is kept by layers
    int emitter;     // index into the emitters: how it emits
    int details;     // index into the conductors, the glasses or the gloss; or NO_DETAILS
    float metallic;  // share of a principled surface that is metal; of glass: ior at the F line minus that at the C line
    float roughness; // roughness of a principled surface, or the factor of an image
    float coverage;  // chance that a path does not meet a hole of the surface
    float crossed;   // factor, from an image, of the share that is glass; of facets with a direction: its angle from u
};

// Emission of lamps that do not emit evenly and to both sides.
struct Emitter {
    vec3 axis;         // unit; v is 1 - cos of the angle to it
    float outer;       // v from which on the lamp emits nothing
    float slope;       // 1 over the length of v over which the emission falls
    int is_one_sided;  // whether it emits only from its front
};
