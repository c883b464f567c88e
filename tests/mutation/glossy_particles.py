"""Bugs of particles at glossy surfaces: what they carry on and bring, and how they are weighed."""

from tests.mutation.mutant import Mutant, edit

_TURNS = "integrators/glossy_turns.glsl"
_BESIDE = "integrators/path_beside_particles.glsl"
_PATH = "integrators/path.glsl"
_PARTICLES = "integrators/particles.glsl"
_LINKS = "integrators/camera_links.glsl"
_SHADERS = "shaders/test_glossy_turns.py"
_CARRIED = f"{_SHADERS}::test_what_arrives_by_the_true_normal_is_spread_by_the_other"
_WEIGHT = f"{_SHADERS}::test_a_particle_carries_what_the_surface_leaves_of_it"
_ROOM = "rendering/test_particles.py::test_particles_change_the_noise_alone[glossy surfaces]"

GLOSSY_PARTICLES = [
    Mutant(
        "paths from the camera are weighed as if glossy surfaces were matte",
        edit(
            _BESIDE,
            "    if (is_glossy(vertex.material)) return glossy",
            "    if (false) return glossy",
        ),
        _ROOM,
    ),
    Mutant(
        "paths from the camera are weighed at links as if particles were scattered there",
        edit(_TURNS, "if (!is_linked) {", "if (true) {"),
        _ROOM,
    ),
    Mutant(
        "particles are weighed as if glossy surfaces were matte",
        edit(_LINKS, "turned = rho * self.turn * turn;", "turned = rho;"),
        _ROOM,
    ),
    Mutant(
        "sampling a lamp is weighed against particles as if glossy surfaces were matte",
        edit(_LINKS, "self.path.depth == 0 ? self.kappa / turn : self.kappa", "self.kappa"),
        _ROOM,
    ),
    Mutant(
        "sampling a lamp beside a glossy surface is weighed as if that were matte",
        edit(_PARTICLES, "self.kappa /= unlike_matte;", "self.kappa /= 1.0;"),
        _ROOM,
    ),
    Mutant(
        "particles carry on light as paths from the camera do",
        edit(_PARTICLES, "linked.value * spread : vec3(0.0);", "next.weight : vec3(0.0);"),
        _CARRIED,
    ),
    Mutant(
        "links from rough glass leave on one side alone",
        edit(_LINKS, "wi.z > 0.0 || crosses && is_rough_glass(vertex.material);", "wi.z > 0.0;"),
        _ROOM,
    ),
    Mutant(
        "links through rough glass do not know on which side they leave",
        edit(_LINKS, "    if (crosses) ray.inward = !ray.inward;\n", ""),
        _ROOM,
    ),
    Mutant(
        "links that leave rough glass are absorbed as if they stayed",
        edit(
            _LINKS,
            "share_left(wi.z < 0.0 ? behind : self.path.absorption, distance);",
            "share_left(self.path.absorption, distance);",
        ),
        _ROOM,
    ),
    Mutant(
        "light that arrives at a link is spread around the normal for shading",
        edit(
            _TURNS,
            "precise vec3 value = lobe.value / arriving;",
            "precise vec3 value = lobe.value / abs(dot(wi, at.shading));",
        ),
        _CARRIED,
    ),
    Mutant(
        "rough glass is met from the same side by those who come from the other",
        edit(_TURNS, "crosses ? 1.0 / vertex.eta : vertex.eta", "vertex.eta"),
        _WEIGHT,
    ),
    Mutant(
        "particles pass a smooth coat as if it were not there",
        edit(_TURNS, "material.alpha > 0.0 && !is_smooth_coat", "material.alpha > 0.0"),
        "rendering/test_particles.py::test_particles_change_the_noise_alone[what particles end at]",
    ),
]
