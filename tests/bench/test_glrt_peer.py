"""glrt as a peer renders what `glrt render` does."""

import numpy as np
import pytest

from bench.entries import GLRT, PEERS, by_default
from bench.glrt_peer import with_particles
from bench.peer import Request
from bench.turns import started
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.settings import settings_for
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.renders import rendered

SKY = {"color": [1.0, 2.0, 3.0]}
SCENE = scene_of([sphere([0, 0, -3], 1, "matte")], {"matte": MATTE}, background=SKY)


@pytest.mark.slow
def test_the_picture_is_that_of_the_request_whatever_came_before(context: Context) -> None:
    size = {"width": 8, "height": 6, "bounces": 2}
    with started({GLRT: PEERS[GLRT]}) as peers:
        for sampler in ("sobol", "independent"):
            for seed in (3, 3, 4):
                asked = Request.of(SCENE, samples=16, seed=seed, sampler=sampler, **size)
                image, seconds = peers[GLRT].render(asked)
                ours = rendered(SCENE, context, 16, seed=seed, sampler=sampler, **size)
                assert np.array_equal(image.radiance, ours.radiance)
                assert seconds > 0


@pytest.mark.slow
def test_long_renders_have_particles_where_they_pay(context: Context) -> None:
    """As `glrt render` has: in a room with a caustic, and not where nothing makes one."""
    for name, caustics in (("methods/caustic", "on"), ("sky", "off")):
        scene = load(name)
        settings = settings_for(scene.render, width=32, height=32)
        assert with_particles(scene, settings, context).caustics == caustics
    asked = by_default(SCENE, 8)
    with started({GLRT: PEERS[GLRT]}) as peers:
        picture, _ = asked.contender(peers).render(64, 3)
    same = rendered(SCENE, context, 64, seed=3, sampler="sobol64", width=8, height=8)
    assert np.array_equal(picture, same.radiance)
