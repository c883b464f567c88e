"""Pictures whose pixels have own counts are unbiased, where rare samples are bright, too."""

from typing import Any

import numpy as np
import pytest

from glrt.error.estimate import block_means
from glrt.gpu.context import Context
from glrt.lab.noisy_scenes import CASES, Case
from glrt.rendering.renderer import Renderer
from tests.support.builders import lamp, room_of_planes, scene_of
from tests.support.renders import rendering

SIDE, BLOCK = 32, 8  # edges of a picture and of a block, in pixels
RENDERS = 128
SAMPLES = 128  # of a pixel on average, half of them the floor
MOST = 0.1  # standard deviations of a render; the mean over all blocks is known to 0.03 of them
TRUTH = 256 * RENDERS  # samples of a pixel


def opened(case: Case, context: Context, **settings: Any) -> Renderer:
    ways = {"method": case.method, "bounces": case.bounces, "width": SIDE, "height": SIDE}
    return Renderer(case.scene, context=context, tier="complete", **{**ways, **settings})


@pytest.fixture(scope="module")
def truths() -> dict[str, Any]:
    """Block means by equal counts, by the name of the scene."""
    return {}


@pytest.mark.slow
@pytest.mark.parametrize("sampler", ["sobol", "independent"])
@pytest.mark.parametrize("name", CASES)
def test_blocks_of_many_renders_have_the_light_of_equal_counts(
    context: Context, name: str, sampler: str, truths: dict[str, Any]
) -> None:
    if name not in truths:
        reference = opened(CASES[name], context, seed=0, sampler="sobol64")
        truths[name] = block_means(reference.render(TRUTH).image().radiance, BLOCK)
        reference.release()
    found = []
    renderer = opened(CASES[name], context, adaptive="on", sampler=sampler)
    for seed in range(RENDERS):
        renderer.update(seed=seed + 1)
        image = renderer.render(SAMPLES).image()
        found.append(block_means(image.radiance, BLOCK))
        assert np.ptp(image.counts)
    renderer.release()
    blocks = np.array(found)
    spread = blocks.std(axis=0, ddof=1)
    z = (blocks.mean(axis=0) - truths[name]) / spread
    assert (spread > 0).all()
    assert abs(z.mean()) < MOST, z.mean(axis=(0, 1))


@pytest.mark.slow
def test_a_room_without_noise_has_the_bits_of_equal_counts(context: Context) -> None:
    scene = scene_of(room_of_planes("glow"), {"glow": lamp(1.0, 0.5)}, {"fov": 90})
    ways: dict[str, Any] = {"roulette": False, "sampler": "sobol", "bounces": 1, "adaptive": "on"}
    with rendering(scene, context, **ways) as renderer:
        image = renderer.render(160).image()
    assert (image.radiance == 1.5).all()
    assert (image.stderr == 0).all()
    assert (image.counts == 160).all()
