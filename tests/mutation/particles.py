"""Bugs of particles: their emission, their link to the camera, their weight, their sums."""

from tests.mutation.mutant import Edit, Mutant, edit

_EMISSION = "lights/particle_emission.glsl"
_WEIGHTS = "integrators/particle_weights.glsl"
_PARTICLES = "integrators/particles.glsl"
_LINKS = "integrators/camera_links.glsl"
_PATH = "integrators/path.glsl"
_BESIDE = "integrators/path_beside_particles.glsl"
_SHADERS = "shaders/test_particles.py"
_LAYERS = "rendering/test_particle_layers.py"
_SOURCES = "shaders/test_particle_sources.py"
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
        edit(_EMISSION, "share_of_side(index, cosine > 0.0));\n}", "1.0);\n}"),
        f"{_SHADERS}::test_directions_from_a_lamp_have_a_density",
    ),
    Mutant(
        "the density does not know how many particles leave each side",
        edit(_EMISSION, "return is_front ? sides.front : sides.back;", "return 0.5;"),
        f"{_SHADERS}::test_most_particles_leave_the_side_that_is_close_to_something",
    ),
    Mutant(
        "particles leave both sides of a lamp alike",
        edit(
            "integrators/particle_start.glsl",
            "precise float front = sides_at(index).front;",
            "precise float front = 0.5;",
        ),
        f"{_SHADERS}::test_most_particles_leave_the_side_that_is_close_to_something",
    ),
    Mutant(
        "particles leave the side of a lamp that is far from everything",
        (Edit("glrt/methods/lamp_sides.py", "front < back", "front > back"),),
        "methods/test_lamp_sides.py::test_most_particles_leave_the_side_that_is_close_to_something",
    ),
    Mutant(
        "a pilot lets bright pixels hide their errors",
        (Edit("glrt/analysis/method_choice/caustics.py", "AROUND = 2 ", "AROUND = 0 "),),
        "analysis/test_caustics_pilot.py::test_a_bright_pixel_does_not_hide_its_own_error",
    ),
    Mutant(
        "particles leave a ball inwards, too",
        edit(_EMISSION, "larger(cosine, 0.0), 1.0)", "abs(cosine), 1.0)"),
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
        edit(_PATH, "if (HAS_PARTICLES) path.rho = rho_beyond(path, vertex, surface, facing);", ""),
        _LIGHT,
    ),
    Mutant(
        "the camera leaves to particles what they do not scatter at",
        edit(_BESIDE, "    if (!carries_particles(vertex.material)) return 0.0;\n", ""),
        _LIGHT,
    ),
    Mutant(
        "the camera leaves to particles what it sees in a mirror",
        edit(
            _BESIDE,
            "return HAS_PARTICLES && is_first && !is_delta(vertex.material);",
            "return HAS_PARTICLES && is_first;",
        ),
        _LIGHT,
    ),
    Mutant(
        "the colour of the surface that is linked is missing",
        edit(
            _LINKS,
            "flux * turn.value * (pdf * weight);",
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
    Mutant(
        "particles leave a disk as if it filled its square",
        edit(_EMISSION, "PI * disk.radius * disk.radius", "4.0 * disk.radius * disk.radius"),
        f"{_SHADERS}::test_directions_from_a_lamp_have_a_density",
    ),
    Mutant(
        "half of a triangle that shines sends particles",
        edit(
            "lights/triangle.glsl",
            "vec2 shares = vec2(root * (1.0 - u.y), root * u.y);",
            "vec2 shares = vec2(0.5 * root * (1.0 - u.y), root * u.y);",
        ),
        f"{_SHADERS}::test_points_on_a_triangle_are_even_in_area",
    ),
    Mutant(
        "of balls around solids one is forgotten in the density",
        edit(
            _EMISSION,
            "FIRST_TARGET + i == certain);\n    }\n    precise float pdf = sum *",
            "FIRST_TARGET + i == certain) * 0.5;\n    }\n    precise float pdf = sum *",
        ),
        f"{_SOURCES}::test_directions_towards_a_ball_around_a_solid_have_a_density",
    ),
    Mutant(
        "what is aimed from the sun is not in the density",
        edit(_EMISSION, "density + frame.aimed * sum / float(ball_count());", "density;"),
        f"{_SOURCES}::test_lines_from_the_sun_have_a_density",
    ),
    Mutant(
        "particles from the sun start beyond no plane",
        edit("integrators/particle_start.glsl", "start -= 2.0 * farthest * direction;", ""),
        f"{_SOURCES}::test_particles_come_from_beyond_the_planes",
    ),
    Mutant(
        "lamps and the sun send the same particles twice",
        edit(_EMISSION, "    if (HAS_SUN) pdf *= 1.0 - frame.from_sun;\n", ""),
        f"{_SOURCES}::test_lamps_and_the_sun_share_the_particles",
    ),
    Mutant(
        "the sun that scattering meets is not weighed against particles",
        edit(
            _PATH,
            "if (HAS_PARTICLES && path.rho > 0.0) {\n        precise float kappa = path.pdf",
            "if (false) {\n        precise float kappa = path.pdf",
        ),
        _LIGHT,
    ),
    Mutant(
        "particles forget which glasses they are in",
        edit(_PARTICLES, "if (HAS_NESTED && next.crosses) self.path.counts = beyond;", ""),
        _LIGHT,
    ),
    Mutant(
        "particles end at glass that is a part of a surface",
        edit(
            _PARTICLES,
            "    if (HAS_TRANSMISSION && material.kind == PRINCIPLED) "
            "material = met_part(material, next_1d(rng));\n",
            "",
        ),
        _LIGHT,
    ),
    Mutant(
        "all particles are on the first layer",
        edit(_LINKS, "min(BY_LENGTH ? length : self.layer, LAYERS - 1)", "0"),
        f"{_LAYERS}::test_a_group_alone_is_the_scene_with_the_other_one_dark",
    ),
    Mutant(
        "layers of particles are a bounce too short",
        edit(_LINKS, "BY_LENGTH ? length : self", "BY_LENGTH ? length - 1 : self"),
        f"{_LAYERS}::test_fewer_bounces_are_the_picture_of_so_many",
    ),
    Mutant(
        "what the window shows of particles forgets their weights",
        edit("weighting.frag", "weights[i] * texelFetch(particles", "texelFetch(particles"),
        f"{_LAYERS}::test_what_is_shown_is_the_picture",
    ),
    Mutant(
        "the sums of layers of particles lie over each other",
        edit("particles.comp", "(layer * size.y + pixel.y)", "pixel.y"),
        f"{_LAYERS}::test_layers_add_up_to_all",
    ),
]
