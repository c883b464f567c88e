// Particles leave the lamps that are sampled, and the sun, where HAS_PARTICLES. A lamp is chosen by its share of the
// flux, a point evenly over its area, and a direction by the cosine. A share `frame.aimed` of the particles takes
// a direction evenly over the cone that a ball fills: these particles make caustics. CASTERS: a bit for each sphere of
// glass, or of metal that is not too rough, by its number; TARGETS: how many balls there are around other such shapes.
//
// Particles from the sun follow its rays. They are spread evenly over the disk that a ball fills across the rays: the
// ball around the scene, or one that is aimed at. Particles from the sky are spread in the same way. Their directions
// are drawn as those of the image of the sky are sampled, or evenly. The sky sends all particles where neither lamps
// nor the sun send any, and the share `frame.from_sky` where it is an image with bright spots (SKY_SENDS, from
// ParticleFacts.sky_sends).

const bool ONLY_SKY_SENDS = SKY_SENDS && CLUSTERS == 0 && !HAS_SUN;

// Whether particles of this light come from the sky.
bool is_from_sky(int light) { return SKY_SENDS && (ONLY_SKY_SENDS || light == SKY_LIGHT); }

// The share of the particles that leaves lamps.
float share_of_lamps() {
    float share = 1.0;
    if (SKY_SENDS) share -= frame.from_sky;
    if (HAS_SUN) share -= frame.from_sun;
    return share;
}

const int NOT_AIMED = -1;
const int FIRST_TARGET = 1 << 20;  // beyond all spheres: the number of the first target that is no sphere

// The number of balls that are aimed at.
int ball_count() { return bitCount(CASTERS) + TARGETS; }

bool is_aimed() { return CASTERS != 0 || TARGETS > 0; }

int choose_emitter(float u) {
    float sum = 0.0;
    int chosen = 0;
    for (int i = 0; i < CLUSTERS; ++i) {
        if (sum <= u) chosen = i;
        sum += cluster_at(i).probability;
    }
    return chosen;
}

bool is_caster(int sphere) { return (CASTERS >> sphere & 1) != 0; }

// 1 / (1 - cos) of the cone that a ball fills, written without the difference. It is 0 where the line passes by, or
// from inside. `certain`: the ray was aimed at this ball, so it counts even if rounding took it past the rim.
float narrowness(vec3 center, float radius, vec3 p, vec3 direction, bool certain) {
    vec3 away = center - p;
    float along = dot(away, direction);
    vec3 beside = away - along * direction;
    float d2 = dot(away, away);
    float r2 = radius * radius;
    bool meets = certain || along > 0.0 && dot(beside, beside) < r2;
    if (!(meets && d2 > r2)) return 0.0;
    float inverse = (d2 + sqrt(d2 * (d2 - r2))) / r2;
    return inverse;
}

// Density per solid angle of directions from p aimed at balls; `certain`: the number of the ball that was aimed at.
float pdf_aimed(vec3 p, vec3 direction, int certain) {
    float sum = 0.0;
    if (CASTERS != 0) {
        for (int i = 0; i < sphere_count(); ++i) {
            if (!is_caster(i)) continue;
            Sphere sphere = sphere_at(i);
            sum += narrowness(sphere.center, sphere.radius, p, direction, i == certain);
        }
    }
    for (int i = 0; i < TARGETS; ++i) {
        Target target = target_at(i);
        sum += narrowness(target.center, target.radius, p, direction, FIRST_TARGET + i == certain);
    }
    float pdf = sum * (0.5 / (PI * float(ball_count())));
    return pdf;
}

// The number of the n-th sphere whose bit is set.
int sphere_of(int bits, int n) {
    int left = n;
    for (int i = 0; i < sphere_count(); ++i) {
        if ((bits >> i & 1) == 0) continue;
        if (left == 0) return i;
        left -= 1;
    }
    return NOT_AIMED;
}

// The number of the target that `u`, from 0 to 1, chooses.
int choose_aim(float u) {
    int n = min(int(u * float(ball_count())), ball_count() - 1);
    int casters = bitCount(CASTERS);
    return n < casters ? sphere_of(CASTERS, n) : FIRST_TARGET + n - casters;
}

Target aimed_at(int number) {
    if (TARGETS > 0 && (CASTERS == 0 || number >= FIRST_TARGET)) return target_at(number - FIRST_TARGET);
    Sphere sphere = sphere_at(number);
    return Target(sphere.center, sphere.radius);
}

// Density per area of the lines across the disk that a ball fills; 0 for lines that pass by.
float density_across(vec3 center, float radius, vec3 p, vec3 direction, bool certain) {
    vec3 away = center - p;
    vec3 beside = away - dot(away, direction) * direction;
    float r2 = radius * radius;
    if (!certain && dot(beside, beside) >= r2) return 0.0;
    float density = 1.0 / (PI * r2);
    return density;
}

// Density of particles from afar on a line through p, per area across the line.
float density_from_afar(vec3 p, vec3 direction, int certain) {
    float density = density_across(frame.bounds_center, frame.bounds_radius, p, direction, false);
    if (is_aimed()) {
        float sum = 0.0;
        if (CASTERS != 0) {
            for (int i = 0; i < sphere_count(); ++i) {
                if (!is_caster(i)) continue;
                Sphere sphere = sphere_at(i);
                sum += density_across(sphere.center, sphere.radius, p, direction, i == certain);
            }
        }
        for (int i = 0; i < TARGETS; ++i) {
            Target target = target_at(i);
            sum += density_across(target.center, target.radius, p, direction, FIRST_TARGET + i == certain);
        }
        density = (1.0 - frame.aimed) * density + frame.aimed * sum / float(ball_count());
    }
    return density;
}

// PI times the density of particles from the sun on a line through p, per area across the line and per solid angle.
// The line has the direction of the sun.
float pdf_from_sun(vec3 p, vec3 direction, int certain) {
    float pdf = PI * frame.from_sun * pdf_sun() * density_from_afar(p, direction, certain);
    return pdf;
}

// Density per solid angle of directions towards the part of the sky that particles come from.
float pdf_sky_direction(vec3 towards) {
    float density = 0.25 / PI;
    if (HAS_ENVIRONMENT) density = pdf_sky(towards);
    return density;
}

// The same for the sky; `direction` is the direction of the particles, and the sky lies behind them.
float pdf_from_sky(vec3 p, vec3 direction, int certain) {
    float pdf = PI * pdf_sky_direction(-direction) * density_from_afar(p, direction, certain);
    if (!ONLY_SKY_SENDS) pdf *= frame.from_sky;
    return pdf;
}

// Least cosine that the density of aimed directions is divided by, to be per projected solid angle. It keeps the
// density finite.
const float LEAST_COSINE = 9.5367431640625e-7;

// A lamp, seen along a ray that leaves it.
struct Aspect {
    float area;      // of one side
    float cosine;    // 0: no particle leaves in this direction
    float by_cosine; // the share of particles that leave this side by the cosine
};

// Share of the particles that leave this side of a flat lamp by the cosine.
float share_of_side(int index, bool is_front) {
    Sides sides = sides_at(index);
    return is_front ? sides.front : sides.back;
}

Aspect aspect_of(int index, vec3 p, vec3 direction) {
    Light light = light_at(index);
    if (is_sphere_lamp(light.shape)) {
        Sphere sphere = sphere_at(light.shape);
        float area = 4.0 * PI * sphere.radius * sphere.radius;
        float cosine = dot(p - sphere.center, direction) / sphere.radius;
        return Aspect(area, larger(cosine, 0.0), 1.0);  // light from inside a lamp is found by scattering alone
    }
    if (is_triangle_lamp(light.shape)) {
        vec3 across = lamp_triangle(light.shape).across;
        float area = length(across);
        float cosine = abs(dot(across, direction)) / area;
        return Aspect(area, cosine, 0.5);
    }
    if (is_disk_lamp(light.shape)) {
        Disk disk = disk_lamp(light.shape);
        float area = PI * disk.radius * disk.radius;
        float cosine = dot(disk.normal, direction);
        return Aspect(area, abs(cosine), share_of_side(index, cosine > 0.0));
    }
    if (is_quad_lamp(light.shape)) {
        Quad quad = quad_lamp(light.shape);
        float area = quad.width * quad.height;
        float cosine = dot(quad.normal, direction);
        return Aspect(area, abs(cosine), share_of_side(index, cosine > 0.0));
    }
    return Aspect(1.0, 0.0, 1.0);
}

// PI times the density of particles that leave a lamp at p, per area and per projected solid angle; 0 where none
// leave. `certain`: see pdf_aimed. For the sun and the sky, p is any point on the line.
float pdf_emission(int index, vec3 p, vec3 direction, int certain) {
    if (is_from_sky(index)) return pdf_from_sky(p, direction, certain);
    if (HAS_SUN && index == SUN_LIGHT) return pdf_from_sun(p, direction, certain);
    int lamp = max(index, 0);  // NVIDIA refuses a constant below 0 here, though the line above returns
    Aspect aspect = aspect_of(lamp, p, direction);
    if (aspect.by_cosine == 1.0 && aspect.cosine == 0.0) return 0.0;
    float by_angle = aspect.by_cosine;
    if (is_aimed()) {
        float aimed = frame.aimed * PI * pdf_aimed(p, direction, certain);
        by_angle = (1.0 - frame.aimed) * by_angle + aimed / larger(aspect.cosine, LEAST_COSINE);
    }
    float pdf = cluster_at(lamp).probability * by_angle / aspect.area;
    if (SKY_SENDS || HAS_SUN) pdf *= share_of_lamps();
    return pdf;
}
