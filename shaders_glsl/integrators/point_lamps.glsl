// Lamps of the classic models: points in their centres, with the power of the whole area.

vec3 eval_shading(Vertex vertex, vec3 wi) {
    if (!OWN_PHONG) return eval_local(vertex, wi);
    Shading shading = phong_shading(own_phong(), vertex, wi);
    vec3 value = shading.base + shading.gloss;
    return value;
}

struct PointLamp {
    vec3 center;
    float disk;    // area that a sphere shows; 0 for a flat lamp
    vec3 facing;   // normal times area of a flat lamp; 0 for a sphere
    int material;
};

PointLamp point_lamp(int shape) {
    if (is_sphere_lamp(shape)) {
        Sphere sphere = sphere_at(shape);
        float disk = PI * sphere.radius * sphere.radius;
        return PointLamp(sphere.center, disk, vec3(0.0), sphere.material);
    }
    if (is_triangle_lamp(shape)) {
        LampTriangle triangle = lamp_triangle(shape);
        vec3 middle = triangle.a + (triangle.edge_b + triangle.edge_c) / 3.0;
        return PointLamp(middle, 0.0, triangle.across, mesh_at(triangle.mesh).material);
    }
    if (is_disk_lamp(shape)) {
        Disk round = disk_lamp(shape);
        vec3 across = PI * round.radius * round.radius * round.normal;
        return PointLamp(round.center, 0.0, across, round.material);
    }
    if (is_quad_lamp(shape)) {
        Quad quad = quad_lamp(shape);
        vec3 center = quad.corner + 0.5 * (quad.edge_u + quad.edge_v);
        vec3 facing = cross(quad.edge_u, quad.edge_v);  // of either sign
        if (HAS_ONE_SIDED && dot(facing, quad.normal) < 0.0) facing = -facing;
        return PointLamp(center, 0.0, facing, quad.material);
    }
    return PointLamp(vec3(0.0), 0.0, vec3(0.0), 0);
}

// Light of a lamp in its centre, scattered towards wo. The direction of `from` is ignored.
vec3 point_light(Vertex vertex, Ray from, int shape) {
    PointLamp lamp = point_lamp(shape);
    vec3 to_center = lamp.center - from.origin;
    float distance = length(to_center);
    if (shape == from.origin_shape || distance == 0.0) return vec3(0.0);
    from.direction = to_center / distance;
    vec3 wi = to_local(vertex.frame, from.direction);
    if (wi.z <= 0.0) return vec3(0.0);
    bool has_shadows = MODEL == WHITTED || MODEL == WHITTED_TREE;
    if (has_shadows && occluded(from, distance, shape)) return vec3(0.0);
    float across = lamp.disk + abs(dot(lamp.facing, from.direction));
    bool is_front = dot(lamp.facing, from.direction) < 0.0;
    vec3 emission = emitted(material_at(lamp.material), -from.direction, is_front);
    vec3 irradiance = across / distance / distance * emission;
    vec3 radiance = irradiance * eval_shading(vertex, wi);
    return radiance;
}
