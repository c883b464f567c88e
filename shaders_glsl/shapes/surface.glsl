// The surface where a ray meets a shape.

// The point of a hit, moved back onto the shape: computed from the distance alone it would lie off the shape.
Surface surface_at(Ray ray, Hit hit) {
    vec3 p = ray.origin + hit.distance * ray.direction;
    if (HAS_SPHERE && up_to_sphere(hit.shape)) return sphere_surface(p, hit.shape);
    if (HAS_PLANE && up_to_plane(hit.shape)) return plane_surface(p, hit.shape);
    if (HAS_QUAD && up_to_quad(hit.shape)) return quad_surface(p, hit.shape);
    if (HAS_DISK && up_to_disk(hit.shape)) return disk_surface(p, hit.shape);
    if (HAS_BOX && up_to_box(hit.shape)) return box_surface(ray, p, hit.shape);
    if (HAS_CYLINDER && up_to_cylinder(hit.shape)) return cylinder_surface(ray, p, hit.shape);
    if (HAS_MESH && up_to_mesh(hit.shape)) return mesh_surface(ray, hit.shape);
    return no_surface();
}
