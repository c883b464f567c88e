// Particles leave lamps that are spheres or quads, where HAS_PARTICLES. A lamp is chosen by its share of the
// flux, a point evenly over its area, a direction by the cosine; or, of a share `frame.aimed` of the particles,
// a direction evenly over the cone that a smooth sphere fills: these make caustics. CASTERS: a bit for each of
// those spheres, by its number.

const int NOT_AIMED = -1;

bool emits_particles(Light light) {
    return !is_of_triangle(light) && !is_of_disk(light);
}

// Of the flux of all lamps that particles leave.
float flux_of_particles() {
    if (!HAS_DISK_LIGHT && !HAS_MESH_LIGHT) return 1.0;
    precise float sum = 0.0;
    for (int i = 0; i < CLUSTERS; ++i) {
        if (emits_particles(light_at(i))) sum += cluster_at(i).probability;
    }
    return sum;
}

int choose_emitter(float u) {
    precise float target = u * flux_of_particles();
    precise float sum = 0.0;
    int chosen = NO_LIGHT;
    for (int i = 0; i < CLUSTERS; ++i) {
        if (!emits_particles(light_at(i))) continue;
        if (chosen == NO_LIGHT || sum <= target) chosen = i;
        sum += cluster_at(i).probability;
    }
    return chosen;
}

bool is_caster(int sphere) { return (CASTERS >> sphere & 1) != 0; }

// Density per solid angle of directions aimed at smooth spheres from p; `certain`: the sphere that one was aimed
// at, which rounding may have taken past its rim. Over a cone it is 1 / (2 PI (1 - cos)), written without the
// difference.
float pdf_aimed(vec3 p, vec3 direction, int certain) {
    precise float sum = 0.0;
    for (int i = 0; i < sphere_count(); ++i) {
        if (!is_caster(i)) continue;
        precise Sphere sphere = sphere_at(i);
        precise vec3 away = sphere.center - p;
        precise float along = dot(away, direction);
        precise vec3 beside = away - along * direction;
        precise float d2 = dot(away, away);
        precise float r2 = sphere.radius * sphere.radius;
        bool meets = i == certain || along > 0.0 && dot(beside, beside) < r2;
        if (meets && d2 > r2) sum += (d2 + sqrt(d2 * (d2 - r2))) / r2;
    }
    precise float pdf = sum * (0.5 / (PI * float(bitCount(CASTERS))));
    return pdf;
}

// The number of the n-th sphere of which a bit is set.
int sphere_of(int bits, int n) {
    int left = n;
    for (int i = 0; i < sphere_count(); ++i) {
        if ((bits >> i & 1) == 0) continue;
        if (left == 0) return i;
        left -= 1;
    }
    return NOT_AIMED;
}

// What the density of aimed directions is per, in place of solid angle: the least cosine keeps it finite.
const float LEAST_COSINE = 9.5367431640625e-7;

// PI times the density of particles that leave a lamp at p, per area and per projected solid angle; 0 where none
// does. `certain` as pdf_aimed has it.
float pdf_emission(int index, vec3 p, vec3 direction, int certain) {
    precise Light light = light_at(index);
    if (!emits_particles(light)) return 0.0;
    precise float area = 0.0;
    precise float cosine = 0.0;
    bool has_two_sides = false;
    if (is_of_sphere(light)) {
        precise Sphere sphere = sphere_at(light.shape);
        area = 4.0 * PI * sphere.radius * sphere.radius;
        cosine = dot(p - sphere.center, direction) / sphere.radius;
        if (cosine <= 0.0) return 0.0;  // light from inside a lamp is found by scattering alone
    } else {
        precise Quad quad = quad_of(light);
        area = quad.width * quad.height;
        cosine = abs(dot(quad.normal, direction));
        has_two_sides = true;
    }
    precise float by_angle = has_two_sides ? 0.5 : 1.0;
    if (CASTERS != 0) {
        precise float aimed = frame.aimed * PI * pdf_aimed(p, direction, certain);
        by_angle = (1.0 - frame.aimed) * by_angle + aimed / larger(cosine, LEAST_COSINE);
    }
    precise float pdf = cluster_at(index).probability / flux_of_particles() * by_angle / area;
    return pdf;
}
