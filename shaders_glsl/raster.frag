// The nearest surface along the ray of each pixel, for one sample. The depth buffer compares distances to the bit.

#include "raster.glsl"
#include "integrators/camera.glsl"

uniform int raster_part;
flat in int drawn;     // number of a shape; of triangles: twice the slot, and which triangle of it
flat in int instance;  // of the triangle's mesh, or 0
layout(location = 0) out ivec2 found;  // shape, and the bits of the distance

// The least distance is 2^-60. Bits of a float rise with its value; the largest depth is 1.
const int FIRST_EXPONENT = 67 << 23;
const int LAST_DEPTH = 0x3F7FFFFF;

// Depths have the order of distances, and the same steps.
float depth_of(float distance) {
    int bits = clamp(floatBitsToInt(distance) - FIRST_EXPONENT, 0, LAST_DEPTH);
    float depth = intBitsToFloat(bits);
    return depth;
}

float proxy_distance(Ray ray, int shape) {
    if (HAS_SPHERE && up_to_sphere(shape)) return sphere_distance(ray, sphere_at(shape), shape);
    if (HAS_PLANE && up_to_plane(shape)) {
        Plane plane = plane_at(shape - first_plane());
        return plane_distance(ray, plane.point, plane.normal);
    }
    if (HAS_QUAD && up_to_quad(shape)) return quad_distance(ray, quad_at(shape - first_quad()));
    if (HAS_DISK && up_to_disk(shape)) return disk_distance(ray, disk_at(shape - first_disk()));
    if (HAS_BOX && up_to_box(shape)) return box_distance(ray, box_at(shape - first_box()), shape);
    if (HAS_CYLINDER && up_to_cylinder(shape)) {
        return cylinder_distance(ray, cylinder_at(shape - first_cylinder()), shape);
    }
    return 0.0;  // a mesh
}

// As in meet_leaf.
Hit met_face(Ray ray) {
    if (!HAS_MESH) return Hit(0.0, NO_SHAPE);
    ShearedRay turned = sheared(ray);
    if (instance > 0) turned = sheared_in(ray, instance);
    Slot slot = slot_at(drawn >> 1);
    vec4 a = uintBitsToFloat(slot.a);
    vec4 b = uintBitsToFloat(slot.b);
    vec4 c = uintBitsToFloat(slot.c);
    vec3 p = sheared_point(turned, a.xyz);
    vec3 q = sheared_point(turned, vec3(a.w, b.xy));
    vec3 r = sheared_point(turned, vec3(b.zw, c.x));
    vec3 s = sheared_point(turned, c.yzw);
    bool is_first = (drawn & 1) == 0;
    vec3 second = is_first ? q : r;
    vec3 third = is_first ? r : s;
    float t = triangle_distance(p, second, third);
    uint turn = is_first ? slot.d.z & 3u : slot.d.z >> 2u;
    if (HAS_HIDDEN_BACK && meets_hidden(turned, p, second, third, turn)) t = 0.0;
    int number = int(is_first ? slot.d.x : slot.d.y) + (HAS_INSTANCE ? instance << INSTANCE_BITS : 0);
    return Hit(t, first_triangle() + number);
}

void main() {
    if (raster_part == BACKDROP) {
        found = ivec2(NO_SHAPE, floatBitsToInt(FAR));
        gl_FragDepth = 1.0;
        return;
    }
    ivec2 place = frame.origin + ivec2(gl_FragCoord.xy);
    Sampler rng = sampler_at(place, frame.first_sample, frame.seed);
    Ray ray = camera_ray(frame.camera, vec2(frame.size), vec2(place), rng);
    Hit hit = Hit(0.0, drawn);
    if (raster_part == FACES) hit = met_face(ray);
    else hit.distance = proxy_distance(ray, drawn);
    if (!(hit.distance > 0.0)) discard;
    found = ivec2(hit.shape, floatBitsToInt(hit.distance));
    gl_FragDepth = depth_of(hit.distance);
}
