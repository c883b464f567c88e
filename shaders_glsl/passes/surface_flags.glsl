// What the first surface behind a pixel is beside its place, as bits: see integrators/middle_surface.glsl.

const int SPECULAR = 1;    // a mirror or glass: what is seen in it moves otherwise than the surface
const int BLURRED = 2;     // out of focus by more than a pixel: several surfaces are seen
const int EDGE = 4;        // samples of the pixel may meet another surface, too
const int LAMP = 8;        // it emits light
const int LAMP_EDGE = 16;  // at an edge of a lamp: what a pixel holds depends on its share of the lamp

bool has_flag(vec4 normal, int flags) {
    return (int(normal.w) & flags) != 0;
}
