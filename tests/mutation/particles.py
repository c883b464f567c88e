"""Bugs of particles: their emission, their link to the camera, their weight, their sums."""

from tests.mutation.mutant import Mutant, edit

_EMISSION = "lights/particle_emission.glsl"
_WEIGHTS = "integrators/particle_weights.glsl"
_PARTICLES = "integrators/particles.glsl"
_LINKS = "integrators/camera_links.glsl"
_PATH = "integrators/path.glsl"
_SHADERS = "shaders/test_particles.py"
_PICTURES = "rendering/test_particles.py"
_LIGHT = f"{_PICTURES}::test_particles_change_the_noise_alone"

PARTICLES = [
    Mutant(
        "the cosine of the splat is missing",
        edit(_WEIGHTS, "pdf_camera(direction) * cosine / (", "pdf_camera(direction) / ("),
        _LIGHT,
    ),
    Mutant(
        "the density of the film forgets a cosine",
        edit(_WEIGHTS, "cosine * cosine * cosine", "cosine * cosine"),
        f"{_SHADERS}::test_rays_from_the_camera_have_a_density",
    ),
    Mutant(
        "particles do not know that lamps are sampled, too",
        edit(_WEIGHTS, "over * over + both * both", "over * over"),
        f"{_SHADERS}::test_the_three_ways_share_all_light",
    ),
    Mutant(
        "what scattering finds forgets that lamps are sampled",
        edit(_WEIGHTS, "1.0 + kappa * kappa + over * over", "1.0 + over * over"),
        f"{_SHADERS}::test_the_three_ways_share_all_light",
    ),
    Mutant(
        "a quad shines to one side alone",
        edit(_EMISSION, "has_two_sides ? 0.5 : 1.0", "1.0"),
        f"{_SHADERS}::test_directions_from_a_lamp_have_a_density",
    ),
    Mutant(
        "particles leave a ball inwards, too",
        edit(_EMISSION, "if (cosine <= 0.0) return 0.0;", "cosine = abs(cosine);"),
        f"{_SHADERS}::test_no_particle_leaves_a_ball_inwards",
    ),
    Mutant(
        "what is aimed is not in the density",
        edit(_EMISSION, "(1.0 - frame.aimed) * by_angle + aimed /", "by_angle + 0.0 * aimed /"),
        f"{_SHADERS}::test_particles_carry_the_flux_of_their_lamp",
    ),
    Mutant(
        "particles choose among lamps without regard to their flux",
        edit(
            _EMISSION,
            "sum += cluster_at(i).probability;\n    }\n    return chosen",
            "sum += 1.0 / float(CLUSTERS);\n    }\n    return chosen",
        ),
        f"{_SHADERS}::test_lamps_are_chosen_as_their_density_says",
    ),
    Mutant(
        "a path that particles bring is counted by the camera, too",
        edit(_PATH, "if (HAS_PARTICLES) path.rho = rho_beyond(path, vertex, surface);", ""),
        _LIGHT,
    ),
    Mutant(
        "the camera leaves to particles what they do not scatter at",
        edit(_PATH, "    if (!carries_particles(vertex.material)) return 0.0;\n", ""),
        _LIGHT,
    ),
    Mutant(
        "the camera leaves to particles what it sees in a mirror",
        edit(_PATH, "    if (is_delta(vertex.material)) return 0.0;\n", ""),
        _LIGHT,
    ),
    Mutant(
        "the colour of the surface that is linked is missing",
        edit(
            _LINKS,
            "flux * (vertex.material.color / PI) * (pdf * weight);",
            "flux * (vec3(0.5) / PI) * (pdf * weight);",
        ),
        _LIGHT,
    ),
    Mutant(
        "light to the camera is not absorbed by glass on the way",
        edit(_PARTICLES, "absorb(self.path, material, side < 0.0, hit.distance);", ";"),
        _LIGHT,
    ),
    Mutant(
        "particles pass what stands before the camera",
        edit(_LINKS, " || occluded(ray, distance, NO_SHAPE)", ""),
        _LIGHT,
    ),
    Mutant(
        "particles are put onto the film without regard to the lens",
        edit(
            _LINKS,
            "dot(d, frame.camera.right) + frame.camera.tan_lens * lens.x",
            "dot(d, frame.camera.right)",
        ),
        f"{_SHADERS}::test_a_particle_arrives_where_the_camera_looks",
    ),
    Mutant(
        "particles scatter once more than paths from the camera may",
        edit(_PARTICLES, "self.path.depth == frame.bounces", "self.path.depth > frame.bounces"),
        f"{_PICTURES}::test_however_many_there_are",
    ),
    Mutant(
        "sums of particles do not carry into their second word",
        edit("particles.comp", "(before > 0xFFFFFFFFu - low ? 1u : 0u)", "0u"),
        f"{_PICTURES}::test_sums_need_both_of_their_words",
    ),
    Mutant(
        "the sums of particles do not begin again at 0",
        edit("splats.comp", "    words[at] = 0u;\n", ""),
        f"{_PICTURES}::test_cornell_keeps_its_light",
    ),
    Mutant(
        "the film of particles keeps its last observation alone",
        edit("splats.comp", "frame.is_empty == 0", "frame.is_empty == 2"),
        f"{_PICTURES}::test_cornell_keeps_its_light",
    ),
]
