"""Particles from lamps, linked through spheres too, bring the light that Mitsuba has."""

from typing import Any

import pytest

from bench.peer import Peer
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.scene.materials.lambertian import Lambertian
from tests.crosscheck.test_mitsuba import judged, ours, theirs
from tests.mitsuba.scenes import everything

LINKED: dict[str, Any] = {"caustics": "on", "linked": 1.0}


@pytest.mark.slow
def test_particles_bring_the_same_light(context: Context, mitsuba: Peer) -> None:
    found = judged(ours(context, everything(), **LINKED), theirs(mitsuba, everything()))
    assert found, str(found)
    assert found.sensitivity.light < 0.02


@pytest.mark.slow
@pytest.mark.parametrize("name", ["methods/caustic", "methods/gap", "cornell"])
def test_so_do_caustics(context: Context, mitsuba: Peer, name: str) -> None:
    """The test also finds walls that reflect less."""
    scene, size = load(name), {"width": 32, "height": 32, "bounces": 6}
    ways: dict[str, Any] = {**size, **LINKED, "sampler": "sobol", "roulette": True}
    reference = theirs(mitsuba, scene, 1 << 14, **size)
    found = judged(ours(context, scene, 1 << 12, **ways), reference)
    assert found, str(found)
    assert found.sensitivity.light < 0.04
    dim = Lambertian(color=(0.65, 0.65, 0.65))
    other = scene.model_copy(update={"materials": {**scene.materials, "white": dim}})
    assert not judged(ours(context, other, 1 << 12, **ways), reference)
