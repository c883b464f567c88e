// Rays against flat disks.

float disk_distance(Ray ray, Disk disk) {
    precise float t = plane_distance(ray, disk.center, disk.normal);
    precise vec3 p = ray.origin + t * ray.direction - disk.center;
    precise float r2 = dot(p, p);
    precise float most = disk.radius * disk.radius;
    return r2 <= most ? t : 0.0;
}

Surface disk_surface(vec3 p, int shape) {
    precise Disk disk = disk_at(shape - first_disk());
    precise vec3 position = p - dot(p - disk.center, disk.normal) * disk.normal;
    return Surface(position, disk.normal, shape, disk.material, disk.light);
}
