"""An estimated error is doubted under fireflies, and nowhere else.

Seeds are fixed; docs/results/stress.md has the figures of whole scenes.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.analysis.stress.noisy_scenes import CASES, room
from glrt.error.reliability import DOUBTFUL, MUTE_LEAST, doubt, error_ratio
from glrt.gpu.context import Context
from glrt.image.image import Image, Pixels
from glrt.rendering.stopping import Ending, Interruption, Limits, render_to_limit
from glrt.scene.scene import Scene
from glrt.scene.toml_writer import write_scene
from tests.support.noisy_images import flat, noisy
from tests.support.processes import glrt
from tests.support.renders import rendering

MATTE = room("red", {"center": [0.9, 2.4, 0.6], "radius": 0.1}, 130.0)  # the caustic without glass


def joined(first: Image, rest: Image) -> Image:
    """The picture of the samples of both."""
    samples = first.samples + rest.samples
    share = np.float32(first.samples / samples)
    return Image(
        share * first.radiance + (1 - share) * rest.radiance,
        np.hypot(share * first.stderr, (1 - share) * rest.stderr),
        samples,
    )


def told(part: Pixels, samples: int, image: Image) -> float | None:
    return error_ratio(part, samples, image.radiance, image.samples, image.error)


def disagreement(first: Image, rest: Image) -> float:
    found = told(first.radiance, first.samples, joined(first, rest))
    assert found is not None
    return found


@pytest.mark.parametrize("samples", [(512, 512), (128, 896), (896, 128)], ids=str)
def test_normal_noise_is_not_doubted(samples: tuple[int, int]) -> None:
    """The error relative to the darker part is a little larger."""
    a, b = (noisy("smooth", n, seed, size=128) for seed, n in enumerate(samples))
    assert 0.97 < disagreement(a, b) < 1.1


@pytest.mark.parametrize("samples", [(64, 64), (32, 96), (96, 32)], ids=str)
def test_rare_large_hits_are_doubted(samples: tuple[int, int]) -> None:
    a, b = (noisy("caustic", n, seed, size=64) for seed, n in enumerate(samples))
    assert disagreement(a, b) > DOUBTFUL


def test_a_few_pixels_have_no_voice() -> None:
    """As at the rim of a lamp that a pixel hardly sees."""
    a, b = (noisy("smooth", 64, seed, size=32) for seed in range(2))
    bright = a.radiance.copy()
    bright.reshape(-1, 3)[:MUTE_LEAST] += 30
    assert disagreement(replace(a, radiance=bright), b) == pytest.approx(
        disagreement(a, b), rel=0.05
    )
    bright.reshape(-1, 3)[MUTE_LEAST] += 30
    assert disagreement(replace(a, radiance=bright), b) > 2 * DOUBTFUL


def test_without_another_part_or_an_estimate_nothing_is_said() -> None:
    image = noisy("smooth", 64, 1)
    unknown = replace(image, stderr=np.full_like(image.stderr, np.nan))
    for part in (0, 64, 65):
        assert told(image.radiance, part, image) is None
    assert told(image.radiance, 32, unknown) is None
    assert told(image.radiance, 32, flat(1.0, 0.0, 64)) is None, "no noise"


def test_a_single_pixel_has_a_voice() -> None:
    one = flat(1.0, 0.1, 64, size=1)
    assert told(1.1 * one.radiance, 32, one) == pytest.approx(1.1, abs=0.15)


def test_a_doubt_is_told_from_twice_the_estimate_on() -> None:
    assert doubt(DOUBTFUL, 0.1).startswith("--error 0.1 may not be reached")
    assert "differ 12 times as much" in doubt(12.3, 0.1)
    assert doubt(1.99, 0.1) == doubt(None, 0.1) == doubt(5.0, None) == ""


def ended(scene: Scene, context: Context, error: float, **settings: Any) -> Ending:
    size = {"width": 48, "height": 48, "bounces": 6, **settings}
    with rendering(scene, context, **size) as renderer:
        return render_to_limit(renderer, Limits(1024, error=error), Interruption())


@pytest.mark.parametrize("sampler", ["independent", "sobol"])
def test_a_caustic_is_doubted_and_a_matte_ball_is_not(context: Context, sampler: str) -> None:
    """Both are judged at 64 samples: half of them must have been looked at before."""
    caustic = ended(CASES["caustic"].scene, context, 0.2, sampler=sampler)
    matte = ended(MATTE, context, 0.2, sampler=sampler)
    assert caustic.image
    assert caustic.image.error
    assert caustic.image.error < 0.2
    assert caustic.error_ratio is not None
    assert caustic.error_ratio > DOUBTFUL
    assert matte.error_ratio is not None
    assert 0.9 < matte.error_ratio < 0.75 * DOUBTFUL


def test_an_error_that_was_not_reached_is_not_doubted(context: Context) -> None:
    size = {"width": 8, "height": 8}
    with rendering(MATTE, context, **size) as renderer:
        ending = render_to_limit(renderer, Limits(64, error=1e-6), Interruption())
    assert ending.image
    assert ending.image.error
    assert ending.error_ratio is None


def test_the_command_warns_of_a_caustic(tmp_path: Path) -> None:
    write_scene(CASES["caustic"].scene, tmp_path / "caustic.toml")
    write_scene(MATTE, tmp_path / "matte.toml")

    def told(scene: str, *options: str) -> str:
        size = ("--width", "48", "--height", "48", "--error", "0.2")
        done = glrt("render", tmp_path / scene, "-o", tmp_path / "a.exr", *size, *options)
        assert done.returncode == 0, done.stderr
        return done.stderr

    assert "caution: --error 0.2 may not be reached" in told("caustic.toml", "--json")
    assert told("caustic.toml", "--quiet") == ""
    assert "caution" not in told("matte.toml")
