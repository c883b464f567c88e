// What the buffers hold. Positions are in scene units, relative to the camera; axes are those of
// the world. Colours are linear sRGB. The twin of shaders_glsl/structs/scene.glsl.

const NO_SHAPE: i32 = -1;

const SPHERE: i32 = 0;
const PLANE: i32 = 1;
const QUAD: i32 = 2;

const MATTE: i32 = 0;       // Lambert's law; lamps are of this kind too
const METAL: i32 = 1;       // mirror or GGX
const DIELECTRIC: i32 = 2;  // smooth interface with Fresnel reflection

// The camera buffer.
struct Camera {
    right: vec3f,  // unit
    tan_x: f32,    // half the width of the image plane at distance 1
    up: vec3f,     // unit
    tan_y: f32,
    forward: vec3f,  // unit
    lens_radius: f32,
    tan_lens: f32,  // lens radius over focus distance
}

// A row of the object buffer; spheres come first, then planes, then quads.
struct Object {
    position: vec3f,  // the centre of a sphere, the corner of a quad, a point of a plane
    kind: i32,
    normal: vec3f,  // unit; of planes and quads
    radius: f32,    // of spheres
    dual_u: vec3f,  // of quads: dot(dual_u, p - position) is 0 at the corner, 1 at the end of edge_u
    material: i32,
    dual_v: vec3f,
}

struct Material {
    color: vec3f,     // albedo or reflectance
    kind: i32,        // MATTE, METAL or DIELECTRIC
    emission: vec3f,  // radiance, light intensity included
    alpha: f32,       // GGX roughness, the square of the scene file's; 0: mirror
    ior: f32,         // inside over outside
}

// What stays the same while samples are gathered.
struct Settings {
    background_bottom: vec3f,  // radiance from below and from above
    bounces: i32,              // scattering events on a path
    background_top: vec3f,
    zero: u32,                 // 0, which the compiler cannot know: see exact
    size: vec2i,               // of the frame, pixels
    sphere_count: i32,
    plane_count: i32,
    quad_count: i32,
}

@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(1) var<storage> objects: array<Object>;
@group(0) @binding(2) var<storage> materials: array<Material>;
@group(0) @binding(3) var<uniform> settings: Settings;
@group(0) @binding(4) var<uniform> samples_so_far: i32;  // the sample counter
