// Rays against spheres, planes and quads, without offsets and tolerances: a ray knows the shape
// that it leaves. The twin of shaders_glsl/shapes/find_hit.glsl.

const FAR: f32 = 3.402823466e38;

struct Hit {
    distance: f32,
    shape: i32,
}

struct Surface {
    position: vec3f,
    normal: vec3f,  // unit; outward on a sphere, else the shape's own
    shape: i32,
    material: i32,
}

// The distance along the ray, not above 0 for a miss (Haines et al., Ray Tracing Gems, 2019).
fn sphere_distance(ray: Ray, sphere: Object, shape: i32) -> f32 {
    let to_center = sphere.position - ray.origin;
    let along = dot3(to_center, ray.direction);
    let beside = to_center - exact3(along * ray.direction);
    let r2 = exact(sphere.radius * sphere.radius);
    let discriminant = r2 - dot3(beside, beside);
    if (shape == ray.leaves) {
        return select(0.0, 2.0 * along, ray.inward);
    }
    if (discriminant <= 0.0) {
        return 0.0;
    }
    let half_chord = sqrt(discriminant);
    let q = select(along - half_chord, along + half_chord, along >= 0.0);
    let c = dot3(to_center, to_center) - r2;
    let t = c / q;
    return select(q, t, t > 0.0);
}

// Infinite or NaN for a parallel ray: no comparison lets that pass.
fn plane_distance(ray: Ray, plane: Object) -> f32 {
    let height = dot3(plane.position - ray.origin, plane.normal);
    let approach = dot3(ray.direction, plane.normal);
    return height / approach;
}

fn quad_distance(ray: Ray, quad: Object) -> f32 {
    let t = plane_distance(ray, quad);
    let p = exact3(ray.origin + exact3(t * ray.direction)) - quad.position;
    let u = dot3(quad.dual_u, p);
    let v = dot3(quad.dual_v, p);
    let inside = u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0;
    return select(0.0, t, inside);
}

// The nearest shape; of two at the same distance the one with the lower number.
fn closest_hit(ray: Ray) -> Hit {
    var hit = Hit(FAR, NO_SHAPE);
    let first_plane = settings.sphere_count;
    let first_quad = first_plane + settings.plane_count;
    let end = first_quad + settings.quad_count;
    for (var shape = 0; shape < first_plane; shape++) {
        let t = sphere_distance(ray, objects[shape], shape);
        if (t > 0.0 && t < hit.distance) {
            hit = Hit(t, shape);
        }
    }
    for (var shape = first_plane; shape < first_quad; shape++) {
        let t = plane_distance(ray, objects[shape]);
        if (t > 0.0 && t < hit.distance && shape != ray.leaves) {
            hit = Hit(t, shape);
        }
    }
    for (var shape = first_quad; shape < end; shape++) {
        let t = quad_distance(ray, objects[shape]);
        if (t > 0.0 && t < hit.distance && shape != ray.leaves) {
            hit = Hit(t, shape);
        }
    }
    return hit;
}

// The point hit, put back onto the shape: the distance alone leaves it beside.
fn surface_at(ray: Ray, hit: Hit) -> Surface {
    let p = ray.origin + exact3(hit.distance * ray.direction);
    let object = objects[hit.shape];
    if (object.kind == SPHERE) {
        let normal = normalized(p - object.position);
        let position = object.position + exact3(object.radius * normal);
        return Surface(position, normal, hit.shape, object.material);
    }
    let height = dot3(p - object.position, object.normal);
    let position = p - exact3(height * object.normal);
    return Surface(position, object.normal, hit.shape, object.material);
}
