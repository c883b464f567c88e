// Flags of the first surface behind a pixel, as bits: see integrators/middle_surface.glsl.

const int SPECULAR = 1;    // a mirror or glass: images in it do not move with the surface
const int BLURRED = 2;     // out of focus by more than a pixel: the pixel shows several surfaces
const int EDGE = 4;        // samples of the pixel may meet another surface, too
const int LAMP = 8;        // it emits light
const int LAMP_EDGE = 16;  // at an edge of a lamp: the pixel's light depends on its share of the lamp
const int CLOUD = 32;      // no surface, but a medium whose density varies: it has no edges

bool has_flag(vec4 normal, int flags) {
    return (int(normal.w) & flags) != 0;
}
