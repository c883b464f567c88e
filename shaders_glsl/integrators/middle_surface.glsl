// The first surface behind the middle of a pixel, seen through the middle of the lens (a G-buffer). It uses no random
// numbers, so that it is the same in every frame.

// position: relative to the eye, and 1 + the number of the object; where the ray meets nothing, a unit
// direction and 0; where the driver cut the search, a unit direction and -1.
// In a medium whose density varies, position and object are those of middle_volume, and the normal faces the eye.
// normal: unit, towards the eye, and the bits of passes/surface_flags.glsl.
struct MiddleSurface {
    vec4 position;
    vec4 normal;
};

// Radius of the circle of confusion, in pixels, of a point at a depth along the view axis; 0 for a pinhole.
float circle_of_confusion(Camera camera, float depth, vec2 size) {
    float slope = camera.lens_radius / depth - camera.tan_lens;
    float radius = abs(slope) * size.y / (2.0 * camera.tan_y);
    return radius;
}

// Whether reflected or refracted directions stay close together.
bool is_specular(Material material) {
    return material.kind != MATTE && material.alpha < 0.25;
}

int surface_flags(Material material, float depth) {
    int flags = is_specular(material) ? SPECULAR : 0;
    if (any(greaterThan(material.emission, vec3(0.0)))) flags += LAMP;
    if (HAS_LENS && circle_of_confusion(frame.camera, depth, vec2(frame.size)) > 1.0) flags += BLURRED;
    return flags;
}

// `place`: pixel in the full frame.
MiddleSurface middle_surface(ivec2 place) {
    Ray ray = middle_ray(place);
    leave_vertex(0u, 0);  // one random number for all pixels: a partly transparent object is seen whole, or not at all
    if (HAS_GRID) {
        vec4 volume = middle_volume(ray);
        if (volume.w > 0.0 && !loop_was_cut) return MiddleSurface(volume, vec4(-ray.direction, float(CLOUD)));
    }
    Hit hit = MAY_PASS ? solid_hit(ray, FAR, NO_SHAPE, frame.camera_counts) : closest_hit(ray);
    if (loop_was_cut) return MiddleSurface(vec4(ray.direction, -1.0), vec4(-ray.direction, 0.0));
    if (hit.shape == NO_SHAPE) return MiddleSurface(vec4(ray.direction, 0.0), vec4(-ray.direction, 0.0));
    Surface surface = surface_at(ray, hit);
    float depth = dot(surface.position, frame.camera.forward);
    int flags = surface_flags(material_of(ray, surface), depth);
    vec3 normal = dot(surface.normal, ray.direction) > 0.0 ? -surface.normal : surface.normal;
    float object = float(1 + object_number(hit.shape));
    return MiddleSurface(vec4(surface.position, object), vec4(normal, float(flags)));
}
