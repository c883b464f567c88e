// From the unit square to disks, hemispheres and cones, and local frames to place them in.

const float PI = 3.14159265358979324;

vec3 normalized(vec3 v) {
    vec3 unit = v / sqrt(dot(v, v));
    return unit;
}

// Uniform on the unit disk.
vec2 sample_disk(vec2 u) {
    float r = sqrt(u.x);
    float phi = 2.0 * PI * u.y;
    vec2 point = r * vec2(cos(phi), sin(phi));
    return point;
}

// Density cos / PI around +z.
vec3 sample_cosine_hemisphere(vec2 u) {
    vec2 disk = sample_disk(u);
    float z = sqrt(1.0 - u.x);
    return vec3(disk, z);
}

// Uniform in solid angle over the cone around +z whose cosine is 1 - one_minus_cos. This form
// keeps the digits of narrow cones.
vec3 sample_cone(float one_minus_cos, vec2 u) {
    float drop = u.x * one_minus_cos;
    float r = sqrt(drop * (2.0 - drop));
    float phi = 2.0 * PI * u.y;
    vec3 direction = vec3(r * cos(phi), r * sin(phi), 1.0 - drop);
    return direction;
}

// An orthonormal frame whose third column is n (Duff et al., "Building an Orthonormal Basis,
// Revisited", JCGT 2017): world = frame * local.
mat3 frame_around(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    vec3 x = vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    vec3 y = vec3(b, s + n.y * n.y * a, -n.y);
    return mat3(x, y, n);
}

vec3 to_local(mat3 frame, vec3 v) {
    vec3 local = vec3(dot(frame[0], v), dot(frame[1], v), dot(frame[2], v));
    return local;
}
