"""An estimated error is doubted where few samples lit the pixels that carry it, and not elsewhere.

Seeds are fixed; docs/results/stress.md has the figures of whole scenes.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bench.fooling_scenes import fooling_scene, metal_balls
from glrt.cli.reports.warnings import doubt
from glrt.error import reliability
from glrt.error.estimate import relative_error
from glrt.error.reliability import LEAST_OBSERVATIONS, is_doubtful
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.lab.noisy_scenes import CASES, room
from glrt.scene.scene import Scene
from glrt.scene.scenefile.toml_writer import write_scene
from tests.support.noisy_images import KINDS, flat, noisy
from tests.support.processes import glrt
from tests.support.renders import rendering

MATTE = room("red", {"center": [0.9, 2.4, 0.6], "radius": 0.1}, 130.0)  # the caustic without glass
MANY = 64  # observations


def judged(image: Image) -> bool | None:
    return is_doubtful(image.radiance, image.stderr, image.samples)


def planted(*spots: tuple[float, float], beside: float = 1.0) -> Image:
    """A grey picture with an error of 2 % and some pixels of other radiance and stderr."""
    image = flat(1.0, 0.02, MANY, size=48)
    for number, (radiance, stderr) in enumerate(spots):
        image.radiance[4, 4 * number + 4] = radiance
        image.stderr[4, 4 * number + 4] = stderr
        image.radiance[5, 4 * number + 4] = beside
    return image


@pytest.mark.parametrize("samples", [64, 1024])
def test_normal_noise_is_believed(samples: int) -> None:
    assert judged(noisy("smooth", samples, 1, size=128)) is False


@pytest.mark.parametrize("samples", [64, 256])
def test_rare_large_hits_are_in_the_estimate(samples: int) -> None:
    """The true error in closed form; by each pixel's own radiance it is a third at most."""
    kind, image = KINDS["caustic"], noisy("caustic", samples, 1, size=64)
    hits = np.where(np.arange(64) >= 64 * kind.first_row, kind.share, 0.0)[:, None, None]
    level = np.linspace(0.6, 1.4, 64)[:, None, None] * np.array([1.0, 0.8, 0.6])
    variance = kind.deviation**2 + kind.hit**2 * hits * (1 - hits)
    truth = level * (kind.base + kind.hit * hits)
    true = relative_error(truth, level * np.sqrt(variance / samples))
    assert true is not None
    assert 0.7 * true < (image.error or 0) < 1.4 * true
    assert (relative_error(image.radiance, image.stderr) or 0) < true / 3


def test_one_pixel_that_one_sample_lit_is_enough() -> None:
    """It is next to a pixel nearly half as bright. A pixel that many samples lit is believed."""
    assert judged(planted()) is False
    assert judged(planted((40.0, 40.0), beside=19.0)) is True
    assert judged(planted((40.0, 4.0), beside=19.0)) is False


def test_a_lone_pixel_that_one_sample_lit_is_in_the_estimate() -> None:
    """Its error is relative to what is around it, so the estimate says how bad it may be."""
    lucky, certain = planted((40.0, 40.0)), planted((40.0, 4.0))
    assert lucky.error == pytest.approx(32 / 48, rel=0.02)
    assert certain.error == pytest.approx(0.02, rel=0.02)
    assert judged(lucky) is False
    assert judged(certain) is False


def test_at_the_rim_of_what_is_bright_for_certain_it_takes_more() -> None:
    assert judged(planted((40.0, 33.0), beside=19.0)) is True
    assert judged(planted((40.0, 24.5), beside=19.0)) is True
    assert judged(planted((40.0, 24.5), beside=60.0)) is False
    assert judged(planted(*[(40.0, 24.5)] * 4, beside=60.0)) is True


def test_a_dark_pixel_has_no_voice() -> None:
    """It hardly counts in the error, however wrong it is."""
    image = planted()
    image.radiance[20, 20] = image.stderr[20, 20] = 0.05
    assert judged(image) is False


def test_what_cannot_be_judged() -> None:
    image = noisy("smooth", MANY, 1)
    nothing = np.full_like(image.stderr, np.nan)
    assert is_doubtful(image.radiance, image.stderr, LEAST_OBSERVATIONS - 1) is None
    assert is_doubtful(image.radiance, image.stderr, LEAST_OBSERVATIONS) is False
    assert is_doubtful(image.radiance, nothing, MANY) is None
    assert judged(flat(1.0, 0.0, MANY)) is None, "no noise"
    assert judged(flat(0.0, 0.0, MANY)) is None, "no light"
    assert image.error_doubtful is None, "without a recipe nobody knows the observations"
    assert doubt(image) == ""


def test_a_single_pixel_is_judged() -> None:
    assert judged(flat(1.0, 0.1, MANY, size=1)) is False
    assert judged(flat(1.0, 1.0, MANY, size=1)) is True


def test_bands_of_rows_are_judged_as_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    image = noisy("caustic", 64, 1)
    whole = reliability._unsure(image.radiance, image.stderr)
    for rows in (1, 5):
        monkeypatch.setattr(reliability, "BAND", rows * image.radiance[0].size)
        banded = reliability._unsure(image.radiance, image.stderr)
        assert all(map(np.array_equal, banded[:5], whole[:5]))


def rendered(scene: Scene, context: Context, samples: int, **settings: Any) -> Image:
    size = {"width": 48, "height": 48, "bounces": 6, "sampler": "sobol", **settings}
    with rendering(scene, context, **size) as renderer:
        return renderer.render(samples).image()


@pytest.mark.slow_cases("cornell-256", "metals-64")
@pytest.mark.slow_cases("metals-256")
@pytest.mark.parametrize("samples", [64, 256])
@pytest.mark.parametrize("name", ["cornell", "lamps", "sky", "metals"])
def test_scenes_of_the_catalogue_are_believed(context: Context, name: str, samples: int) -> None:
    image = rendered(load(name), context, samples)
    assert image.error_doubtful is False
    assert doubt(image) == ""


@pytest.mark.parametrize("sampler", ["independent", "sobol"])
def test_the_error_of_a_caustic_is_estimated_right(context: Context, sampler: str) -> None:
    """It is 0.67 and 0.38 (4,096 samples); by each pixel's own radiance 0.10 and 0.08."""
    image = rendered(CASES["caustic"].scene, context, 64, sampler=sampler)
    truth = {"independent": 0.67, "sobol": 0.38}[sampler]
    assert 0.6 * truth < (image.error or 0) < 1.6 * truth
    assert rendered(MATTE, context, 64, sampler=sampler).error_doubtful is False


@pytest.mark.parametrize(("samples", "truth"), [(64, 0.97), (256, 1.0)])
def test_the_error_of_metal_balls_by_light_sampling_is_estimated_right(
    context: Context, samples: int, truth: float
) -> None:
    """Truth by 4,096 samples of `mis`; by each pixel's own radiance 0.12 and 0.11."""
    image = rendered(metal_balls(0.15), context, samples, method="nee")
    assert 0.6 * truth < (image.error or 0) < 1.6 * truth


def test_metal_balls_by_light_sampling_are_doubted(context: Context) -> None:
    image = rendered(metal_balls(0.15), context, 64, method="nee")
    assert image.error_doubtful is True
    assert "or --method mis" in doubt(image)


def test_the_rim_of_a_small_sun_is_doubted(context: Context) -> None:
    """One pixel carries the error: 2.6 % are estimated, 19 % are true."""
    scene, _ = fooling_scene("rims of small suns", 30014)
    image = rendered(scene, context, 64, height=36, seed=4)
    assert image.error
    assert image.error < 0.03
    assert image.error_doubtful is True


def test_it_is_known_of_a_file_and_not_of_few_samples(context: Context, tmp_path: Path) -> None:
    caustic = rendered(CASES["caustic"].scene, context, 64)
    caustic.save(tmp_path / "a.exr")
    assert Image.load(tmp_path / "a.exr").error_doubtful is True
    assert rendered(CASES["caustic"].scene, context, 48).error_doubtful is None


@pytest.mark.slow
def test_the_command_warns_with_and_without_a_wanted_error(tmp_path: Path) -> None:
    write_scene(CASES["caustic"].scene, tmp_path / "caustic.toml")
    write_scene(MATTE, tmp_path / "matte.toml")

    def told(scene: str, *options: str) -> tuple[str, Any]:
        size = ("--width", "48", "--height", "48", *options)
        done = glrt("render", tmp_path / scene, "-o", tmp_path / "a.exr", *size)
        assert done.returncode == 0, done.stderr
        return done.stderr, json.loads(done.stdout)["error_doubtful"] if done.stdout else None

    for limit in (("--error", "0.3"), ("--samples", "64")):
        text, is_told = told("caustic.toml", "--json", *limit)
        assert "caution: the estimated error, " in text
        assert "is not to be believed" in text
        assert is_told is True
    text, is_told = told("caustic.toml", "--quiet", "--error", "0.3")
    assert "caution: the estimated error, " in text
    assert len(text.splitlines()) == 1
    assert is_told is None
    text, is_told = told("matte.toml", "--json", "--error", "0.2")
    assert "caution" not in text
    assert is_told is False
    assert told("matte.toml", "--json", "--samples", "32")[1] is None
