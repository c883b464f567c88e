"""Bugs of particles at surfaces with normals for shading: what they carry and weigh."""

from tests.mutation.mutant import Mutant, edit

_NORMALS = "integrators/shading_normals.glsl"
_PARTICLES = "integrators/particles.glsl"
_LINKS = "integrators/camera_links.glsl"
_TURNS = "integrators/glossy_turns.glsl"
_PATH = "integrators/path.glsl"
_BESIDE = "integrators/path_beside_particles.glsl"
_OWN = "rendering/test_particle_normals.py"
_MATTE = f"{_OWN}::test_a_matte_surface_takes_light_by_its_shading_normal"
_MIRROR = f"{_OWN}::test_a_mirror_reflects_by_its_shading_normal"
_SHARES = f"{_OWN}::test_the_ways_share_light_where_normals_differ"
_ROOM = f"{_OWN}::test_smooth_meshes_change_the_noise_alone"

PARTICLE_NORMALS = [
    Mutant(
        "the adjoint correction of shading normals is missing in links",
        edit(_TURNS, "turn * (vertex.material.color / PI)", "vertex.material.color / PI"),
        _MATTE,
    ),
    Mutant(
        "the adjoint correction of shading normals is missing where particles scatter",
        edit(_PARTICLES, "        share *= turn;\n", ""),
        _MIRROR,
    ),
    Mutant(
        "mirrors with shading normals are corrected as matte surfaces are",
        edit(_NORMALS, "if (is_smooth) turn *=", "if (false) turn *="),
        _MIRROR,
    ),
    Mutant(
        "paths from the camera are weighed without shading normals",
        edit(_PATH, "path.rho *= path_turn(", "path.rho += 0.0 * path_turn("),
        _SHARES,
    ),
    Mutant(
        "sampled light is weighed without shading normals",
        edit(_PATH, "if (HAS_PARTICLES) rho *=", "if (HAS_PARTICLES) rho += 0.0 *"),
        _SHARES,
    ),
    Mutant(
        "particles are weighed without shading normals",
        edit(_LINKS, "turned = rho * self.turn * turn;", "turned = rho;"),
        _SHARES,
    ),
    Mutant(
        "the density of the film is that of shading normals",
        edit(
            _BESIDE, "HAS_SHADING ? -dot(path.ray.direction, facing) : vertex.wo.z", "vertex.wo.z"
        ),
        _SHARES,
    ),
    Mutant(
        "particles scatter around shading normals where no path from the camera does",
        edit(_PARTICLES, " && is_flat_towards(normals, next.direction) == is_flat", ""),
        _ROOM,
    ),
]
