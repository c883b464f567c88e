// Rays against flat disks.

float disk_distance(Ray ray, Disk disk) {
    float t = plane_distance(ray, disk.center, disk.normal);
    vec3 p = ray.origin + t * ray.direction - disk.center;
    float r2 = dot(p, p);
    float most = disk.radius * disk.radius;
    return r2 <= most ? t : 0.0;
}

Surface disk_surface(vec3 p, int shape) {
    Disk disk = disk_at(shape - first_disk());
    vec3 position = p - dot(p - disk.center, disk.normal) * disk.normal;
    return Surface(position, disk.normal, shape, disk.material, disk.light);
}
