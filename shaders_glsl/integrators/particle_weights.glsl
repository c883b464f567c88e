// Three ways find the same light: scattering from the camera that meets a lamp, a point sampled on a lamp, and a
// particle from a lamp that is linked to the camera. The power heuristic weighs them (Veach 1997, section 9.2) by
// densities of whole paths: P0 of scattering, P1 of sampling, PL of particles.
//
// Matte and smooth surfaces scatter with the same density in both directions of a path, per projected solid angle. So
// P0 and PL agree between the lamp and the first surface that the camera sees. One number a path is enough:
//     P0 / PL = rho / pdf_emission,   rho = pdf_film / frame.particles
//     P1 / P0 = kappa: the density of sampling the lamp over the density of scattering to it, at the last vertex;
//               0 where that vertex is smooth
// Normals for shading and glossy surfaces break this symmetry. Then the ratios at the vertices where the path scatters
// are factors as well: of rho of a path from the camera, and of the turn of a particle
// (integrators/shading_normals.glsl, glossy_turns.glsl).
// The densities leave out roulette on both sides.

// Density of camera rays per solid angle, over the whole frame, at their point of the lens.
float pdf_camera(vec3 direction) {
    float cosine = dot(direction, frame.camera.forward);
    if (cosine <= 0.0) return 0.0;
    float pdf = 1.0 / (4.0 * frame.camera.tan_x * frame.camera.tan_y * cosine * cosine * cosine);
    return pdf;
}

// The same density per area of a surface that the ray meets; `cosine`: between the ray and the surface's normal.
float pdf_film(vec3 direction, float cosine, float distance) {
    float pdf = pdf_camera(direction) * cosine / (distance * distance);
    return pdf;
}

// Weight of a sampled point: P1^2 over the sum of squares. `scattered`: the density of scattering to it.
float sample_beside_particles(LightSample light, float scattered, float rho) {
    int sender = SKY_SENDS && light.light == NO_LIGHT ? SKY_LIGHT : light.light;
    vec3 point = light.ray.origin;
    if (!is_from_sky(sender) && sender != SUN_LIGHT) point += light.distance * light.ray.direction;
    float ratio = scattered / light.pdf;
    float over = 0.0;
    if (sender != NO_LIGHT) over = ratio * pdf_emission(sender, point, -light.ray.direction, NOT_AIMED) / rho;
    float weight = 1.0 / (1.0 + ratio * ratio + over * over);
    return weight;
}

// Weight of emission that scattering met: P0^2 over the sum of squares. `kappa`: P1 / P0.
float emission_beside_particles(Ray ray, Hit hit, int light, float kappa, float rho) {
    vec3 point = ray.origin + hit.distance * ray.direction;
    float over = pdf_emission(light, point, -ray.direction, NOT_AIMED) / rho;
    float weight = 1.0 / (1.0 + kappa * kappa + over * over);
    return weight;
}

// Weight of a particle linked to the camera: PL^2 over the sum of squares. `over`: P0 / PL.
float particle_weight(float over, float kappa) {
    float both = over * kappa;  // P1 / PL: the square of kappa alone may overflow
    float weight = 1.0 / (1.0 + over * over + both * both);
    return weight;
}

// --- lights that the camera sees, straight or through one smooth sphere -----------------------
//
// Two ways find them: a ray from the camera that meets a light, and the point on a lamp where a particle leaves, or the
// direction that it comes from, which is linked to the camera (integrators/light_links.glsl).

const bool LINKS_LIGHTS = HAS_PARTICLES && !HAS_COINCIDENT;

// A ray from the camera counts as so many particles. A large lamp is even where rays meet it, and spotted by links.
const float STEADY = 32.0;

// Density of the points of a lamp that are linked, per area of the side that faces `direction`.
float density_on_lamp(int lamp, vec3 p, vec3 direction) {
    Aspect aspect = aspect_of(lamp, p, direction);
    if (aspect.cosine == 0.0) return 0.0;
    float density = cluster_at(lamp).probability / aspect.area;
    if (SKY_SENDS || HAS_SUN) density *= share_of_lamps();
    return density;
}

// Density of the directions in which the sun or the sky is linked, per solid angle.
float density_of_afar(int light, vec3 towards) {
    float density = 0.0;
    if (is_from_sky(light)) density = pdf_sky_direction(towards) * (ONLY_SKY_SENDS ? 1.0 : frame.from_sky);
    else if (HAS_SUN) density = pdf_sun() * frame.from_sun;
    return density;
}

// Weights of such a link, and of a ray that meets the light; `over`: the density of rays over that of links.
float weight_of_light_link(float over) {
    float weighted = STEADY * over;
    return particle_weight(weighted, 0.0);
}

float weight_beside_links(float over) {
    float weighted = 1.0 / (STEADY * over);
    return particle_weight(weighted, 0.0);
}
