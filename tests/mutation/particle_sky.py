"""Bugs of particles from the sky."""

from tests.mutation.mutant import Mutant, edit

_OWN = "rendering/test_particles_from_sky.py"
_LIGHT = f"{_OWN}::test_particles_change_the_noise_alone"

PARTICLE_SKY = [
    Mutant(
        "the sky that scattering meets is not weighed against its particles",
        edit("integrators/path.glsl", "if (SKY_SENDS && path.rho > 0.0)", "if (false)"),
        f"{_OWN}::test_a_white_furnace_stays_white",
    ),
    Mutant(
        "what is sampled of the sky forgets its particles",
        edit(
            "integrators/particle_weights.glsl",
            "if (SKY_SENDS || light.light != NO_LIGHT)",
            "if (light.light != NO_LIGHT)",
        ),
        f"{_OWN}::test_the_sky_is_shared_by_three_ways",
    ),
    Mutant(
        "particles from the sky forget that its image is sampled",
        edit("integrators/particles.glsl", "if (SAMPLE_SKY) sampled = pdf_sky(towards);", ";"),
        _LIGHT,
    ),
    Mutant(
        "particles come evenly from an image of the sky, by their density alone",
        edit(
            "lights/particle_emission.glsl",
            "if (HAS_ENVIRONMENT) density = pdf_sky(towards);",
            "",
        ),
        _LIGHT,
    ),
    Mutant(
        "the sky sends particles from below their lines",
        edit(
            "lights/particle_emission.glsl",
            "PI * pdf_sky_direction(-direction)",
            "PI * pdf_sky_direction(direction)",
        ),
        _LIGHT,
    ),
]
