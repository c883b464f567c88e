// Light sampling. A lamp is chosen (lights/choice.glsl); then a point on a quad, a disk or a triangle, or a direction
// in the cone that a sphere fills. Densities are per solid angle at the ray's origin and contain the choice.
//
// The density is 0, and scattering alone finds the light, in these cases: planes (infinite area), boxes and
// cylinders, the background, the lamp just left, a sphere that contains the point, and a quad, a disk or a
// triangle in a plane through the point.

struct LightSample {
    Ray ray;
    float distance;
    float pdf;      // 0: nothing was sampled
    vec3 radiance;
    int shape;
    int layer;      // of its light group
    int light;      // its number, or NO_LIGHT
};

// 1 - cos of the cone that a sphere fills, without the cancellation of 1 - sqrt(1 - s2);
// 0 when the sphere contains the point.
float cone_of_sphere(vec3 to_center, float radius) {
    float s2 = radius * radius / dot(to_center, to_center);
    if (s2 >= 1.0) return 0.0;
    float one_minus_cos = s2 / (1.0 + sqrt(1.0 - s2));
    return one_minus_cos;
}

// Whether a point lies off the disk's plane.
bool is_beside(Disk disk, vec3 origin) {
    float z = dot(disk.center - origin, disk.normal);
    return z * z > 0.0;
}

// Whether sampling may find this lamp from the ray's origin.
bool is_sampled(int index, Ray ray) {
    Light light = any_light(index);
    if (light.shape == ray.origin_shape) return false;
    if (is_sphere_lamp(light.shape)) {
        Sphere sphere = sphere_at(light.shape);
        return cone_of_sphere(sphere.center - ray.origin, sphere.radius) > 0.0;
    }
    if (is_triangle_lamp(light.shape)) return is_beside(lamp_triangle(light.shape), ray.origin);
    if (is_disk_lamp(light.shape)) return is_beside(disk_lamp(light.shape), ray.origin);
    if (is_quad_lamp(light.shape)) return is_beside(quad_lamp(light.shape), ray.origin);
    return false;
}

// QUADS_BY_AREA: points even in area replace points even in solid angle where both strategies are weighted. There
// they are as good and cheaper, since the weights leave light near a lamp to scattering. Light sampling alone
// would miss near light.
float pdf_quad(Quad quad, Ray ray, float distance) {
    if (QUADS_BY_AREA) {
        float cos_light = abs(dot(ray.direction, quad.normal));
        if (cos_light == 0.0) return 0.0;
        float pdf = (distance / (quad.width * quad.height)) * (distance / cos_light);
        return pdf;
    }
    StripView view = view_strips(quad, ray.origin);
    float share = dot(quad.dual_u, distance * ray.direction - view.corner);
    return pdf_strips(quad, view, clamp(share, 0.0, 1.0));
}

// Points are even in area, in every method.
float pdf_disk(Disk disk, Ray ray, float distance) {
    float cos_light = abs(dot(ray.direction, disk.normal));
    if (cos_light == 0.0) return 0.0;
    float pdf = distance / (PI * disk.radius * disk.radius) * distance / cos_light;
    return pdf;
}

// The density of choosing this lamp and sampling this ray, which meets the lamp at this distance; `lamps`
// is the total_weight at the ray's origin.
float pdf_light(int index, Ray ray, float distance, float lamps) {
    if (!is_sampled(index, ray)) return 0.0;
    Light light = any_light(index);
    float choice = choice_pdf(index, ray, lamps);
    if (is_sphere_lamp(light.shape)) {
        Sphere sphere = sphere_at(light.shape);
        float one_minus_cos = cone_of_sphere(sphere.center - ray.origin, sphere.radius);
        float pdf = choice / (2.0 * PI * one_minus_cos);
        return pdf;
    }
    if (is_triangle_lamp(light.shape)) {
        LampTriangle triangle = lamp_triangle(light.shape);
        float pdf = choice * pdf_triangle(triangle, ray, distance);
        return pdf;
    }
    if (is_disk_lamp(light.shape)) {
        float pdf = choice * pdf_disk(disk_lamp(light.shape), ray, distance);
        return pdf;
    }
    if (is_quad_lamp(light.shape)) {
        float pdf = choice * pdf_quad(quad_lamp(light.shape), ray, distance);
        return pdf;
    }
    return 0.0;
}

// Whether a sample shows a lamp from where it emits nothing: then no shadow ray is needed.
bool is_dark(LightSample light) {
    return IS_AIMED && light.radiance == vec3(0.0);
}

LightSample no_light_sample(Ray ray) {
    return LightSample(ray, 0.0, 0.0, vec3(0.0), NO_SHAPE, 0, NO_LIGHT);
}

// A point of a lamp, seen from the origin of a ray.
struct LampPoint {
    vec3 direction;
    float distance;  // 0: nothing can be seen
    int material;
    bool facing;     // whether the lamp shows its front
};

LampPoint no_lamp_point() {
    return LampPoint(vec3(0.0), 0.0, 0, false);
}

LampPoint sphere_point(Ray ray, int shape, vec2 u) {
    Sphere sphere = sphere_at(shape);
    vec3 to_center = sphere.center - ray.origin;
    float one_minus_cos = cone_of_sphere(to_center, sphere.radius);
    if (one_minus_cos == 0.0 || shape == ray.origin_shape) return no_lamp_point();
    vec3 local = sample_cone(one_minus_cos, u);
    vec3 direction = normalized(frame_around(normalized(to_center)) * local);
    ray.direction = direction;
    float distance = sphere_distance(ray, sphere, shape);
    if (distance <= 0.0) distance = dot(to_center, ray.direction);  // rounded past the rim
    return LampPoint(direction, distance, sphere.material, true);
}

LampPoint flat_point(vec3 to_point, int material, vec3 normal) {
    float distance = length(to_point);
    if (distance == 0.0) return no_lamp_point();
    vec3 direction = to_point / distance;
    return LampPoint(direction, distance, material, dot(direction, normal) < 0.0);
}

LampPoint quad_point(Ray ray, int shape, vec2 u) {
    Quad quad = quad_lamp(shape);
    vec2 share = u;
    if (!QUADS_BY_AREA) share = sample_strips(quad, view_strips(quad, ray.origin), u);
    vec3 to_point = quad.corner - ray.origin + share.x * quad.edge_u + share.y * quad.edge_v;
    return flat_point(to_point, quad.material, quad.normal);
}

LampPoint disk_point(Ray ray, int shape, vec2 u) {
    Disk disk = disk_lamp(shape);
    vec2 place = disk.radius * sample_disk(u);
    vec3 to_place = disk.center - ray.origin + frame_around(disk.normal) * vec3(place, 0.0);
    return flat_point(to_place, disk.material, disk.normal);
}

LampPoint triangle_point(Ray ray, int shape, vec2 u) {
    LampTriangle triangle = lamp_triangle(shape);
    vec2 shares = sample_triangle(u);
    vec3 offset = triangle.a - ray.origin + shares.x * triangle.edge_b + shares.y * triangle.edge_c;
    return flat_point(offset, mesh_at(triangle.mesh).material, triangle.across);
}

LampPoint sample_point(Light light, Ray ray, vec2 u) {
    if (is_sphere_lamp(light.shape)) return sphere_point(ray, light.shape, u);
    if (is_triangle_lamp(light.shape)) return triangle_point(ray, light.shape, u);
    if (is_disk_lamp(light.shape)) return disk_point(ray, light.shape, u);
    if (is_quad_lamp(light.shape)) return quad_point(ray, light.shape, u);
    return no_lamp_point();
}

// A sample of the lamp with this index; the rest as for `sample_light`.
LightSample sample_lamp(Ray ray, int index, vec2 u, float lamps) {
    Light light = any_light(index);
    LampPoint point = sample_point(light, ray, u);
    if (point.distance == 0.0) return no_light_sample(ray);
    ray.direction = point.direction;
    Material lamp = material_at(point.material);
    float pdf = pdf_light(index, ray, point.distance, lamps);
    vec3 radiance = emitted(lamp, -point.direction, point.facing);
    return LightSample(ray, point.distance, pdf, radiance, light.shape, lamp.layer, index);
}

// A sample from the origin of `ray`, whose direction is ignored. `lamps`: the weight of all lamps there.
LightSample sample_light(Ray ray, float lamps, inout Sampler rng) {
    vec3 choice = vec3(0.0);
    if (MANY_LIGHTS) choice.yz = next_2d(rng);
    if (CLUSTERS > 1) choice.x = next_1d(rng);
    vec2 u = next_2d(rng);
    int index = choose_light(ray, lamps, choice);
    if (IS_AIMED && index == NO_LIGHT) return no_light_sample(ray);
    return sample_lamp(ray, index, u, lamps);
}
