"""The pilot of `--caustics auto`: what it finds, and that no clock decides."""

import random
import time
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.analysis.method_choice import caustics
from glrt.analysis.method_choice.caustics import CHOICES, may_gain, particles_worth
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for
from tests.support.builders import MATTE, glass, lamp, plane, scene_of, sphere
from tests.support.sun_map import even_sky, sun_map

BALL = "methods/caustic"


def test_a_choice_that_is_given_whole_is_tried_once(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    gains = iter([0.95])
    monkeypatch.setattr(caustics, "_gain", lambda *_: next(gains))
    given = {"particles": 0.3, "aimed": 0.4, "linked": 0.5}
    found = particles_worth(load(BALL), Settings(width=8, height=8), context, given)
    assert found == (settings_for(Settings(width=8, height=8), caustics="off"), 0.95)
    assert [*gains] == []


def test_links_are_tried_where_a_sphere_has_them(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Links do not go through thin glass."""
    tried: list[float] = []

    def gain(_: Scene, settings: Settings, *__: object) -> float:
        tried.append(settings.linked)
        return 1.0

    monkeypatch.setattr(caustics, "_gain", gain)
    ball = under_a_ball(0.1)
    thin = ball.model_copy(update={"materials": {**ball.materials, "glass": Dielectric(thin=True)}})
    for scene, expected in ((ball, [0, 0, 1]), (thin, [0, 0])):
        particles_worth(scene, Settings(width=8, height=8), context)
        assert tried == expected
        tried.clear()


def test_the_first_choice_may_be_hopeless(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Then only links are tried: a tiny lamp may be seen in a mirror ball alone."""
    gains = iter([0.5, 9.0])
    monkeypatch.setattr(caustics, "_gain", lambda *_: next(gains))
    found = particles_worth(load(BALL), Settings(width=8, height=8), context)
    assert found
    assert (found.settings.linked, found.gain, [*gains]) == (1.0, 9.0, [])


def test_without_links_a_hopeless_choice_is_the_last(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    gains = iter([0.5, 9.0])
    monkeypatch.setattr(caustics, "_gain", lambda *_: next(gains))
    found = particles_worth(load("cornell"), Settings(width=8, height=8), context, {"linked": 0.0})
    assert found
    assert (found.settings.caustics, found.gain, [*gains]) == ("off", 0.5, [9.0])


@pytest.mark.parametrize(
    ("gains", "chosen"),
    [
        ((2.0, 1.9, 1.8), 2),
        ((1.3, 1.0, 1.12), 0),
        ((2.0, 1.8, 1.6), 1),
        ((1.6, 1.6, 2.0), 2),
        ((2.0, 1.6, 1.6), 0),
    ],
)
def test_of_choices_that_gain_about_as_much_the_last_one_is_taken(
    gains: tuple[float, ...], chosen: int, context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It finds more of the light that the pilot misses."""
    left = iter(gains)
    monkeypatch.setattr(caustics, "_gain", lambda *_: next(left))
    monkeypatch.setattr(caustics, "_picture", lambda *_: None)
    settings = Settings(width=8, height=8)
    found = particles_worth(load(BALL), settings, context)
    assert found == (settings_for(settings, caustics="on", **CHOICES[chosen]), gains[chosen])


def test_a_bright_pixel_does_not_hide_its_own_error() -> None:
    """Relative to it alone, an error that comes with a bright pixel would count as any other."""
    radiance = np.ones((16, 16, 3), np.float32)
    errors = 0.1 * radiance
    assert_allclose(caustics.around(radiance), radiance)
    assert caustics.variance_of(caustics.around(radiance), errors) == pytest.approx(0.01, rel=0.02)
    radiance[8, 8], errors[8, 8] = 26, 13
    level = caustics.around(radiance)
    assert_allclose(level[6:11, 6:11], 2)
    assert caustics.variance_of(level, errors) > 2 * caustics.variance_of(radiance, errors)


def picture(height: int, width: int, error: float) -> Any:
    """A grey picture as `_unseen` takes them."""
    ones = np.ones((height, width, 3), np.float32)
    return SimpleNamespace(radiance=ones, stderr=error * ones)


@pytest.mark.parametrize(("height", "width"), [(16, 16), (20, 13)])
@pytest.mark.parametrize(("extra", "is_missed"), [(0.5, True), (0.005, False), (-0.5, False)])
def test_a_caustic_that_is_missed_counts_as_found_by_one_path(
    height: int, width: int, extra: float, is_missed: bool
) -> None:
    """Noise elsewhere does not hide it: here it hides the gap in the frame."""
    plain, other = picture(height, width, 0.01), picture(height, width, 0.01)
    plain.stderr[8:, 8:] = 50.0
    other.radiance[:8, :8] += extra
    found = caustics._unseen(plain, other, np.ones_like(plain.radiance))
    squares = 8 * 8 * (8 * 8 * 0.5**2) / (height * width)
    assert found == pytest.approx(squares / 1.01 if is_missed else 0.0, rel=1e-3)


def test_light_that_is_missed_everywhere_is_seen_in_the_frame_alone() -> None:
    plain, other = picture(32, 32, 0.2), picture(32, 32, 0.2)
    assert caustics._unseen(plain, other, np.ones_like(plain.radiance)) == 0.0
    other.radiance += 0.1  # less than 5 standard errors of a tile
    found = caustics._unseen(plain, other, np.ones_like(plain.radiance))
    assert found == pytest.approx(32 * 32 * 0.1**2 / 1.01, rel=1e-3)


def under_a_ball(radius: float) -> Scene:
    """A floor with the caustic of a lamp that shines as much whatever its size, and its light."""
    things = [
        plane([0, 0, 0], [0, 1, 0], "floor"),
        sphere([0, 0.8, 0], 0.5, "glass"),
        sphere([0.4, 3, 0.2], radius, "lamp"),
    ]
    materials = {"floor": MATTE, "glass": glass(), "lamp": lamp(9 / radius**2)}
    camera = {"position": [0, 1.2, 3.5], "look_at": [-0.1, 0, 0.05], "fov": 12}
    return scene_of(things, materials, camera=camera)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [0.1, 1e-4])
def test_light_that_no_path_finds_is_not_taken_for_darkness(
    radius: float, context: Context
) -> None:
    """Without particles, a picture's errors miss the caustic of a tiny lamp."""
    found = particles_worth(under_a_ball(radius), Settings(width=32, height=32), context)
    assert found
    assert found.settings.caustics == "on"
    assert found.gain > 10


@pytest.mark.slow
def test_a_dark_scene_gains_nothing(context: Context) -> None:
    things = [sphere([0, 0, -3], 0.5, "glass"), sphere([0, 0, 9], 0.5, "lamp")]
    dark = scene_of(things, {"glass": glass(), "lamp": lamp(0.0)})
    found = particles_worth(dark, Settings(width=8, height=8), context)
    assert found
    assert (found.settings.caustics, found.gain) == ("off", 0.0)


@pytest.mark.slow
def test_no_clock_decides(context: Context, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load(BALL)
    settings = settings_for(scene.render, width=24, height=24, bounces=4)
    plain = particles_worth(scene, settings, context)
    now, strides = 0.0, random.Random(1)

    def nonsense() -> float:
        nonlocal now
        now += strides.choice([0.0, 1e-6, 3.0, 1e4])
        return now

    monkeypatch.setattr(time, "perf_counter", nonsense)
    assert particles_worth(scene, settings, context) == plain


@pytest.mark.slow
def test_blocks_of_64_are_judged_as_blocks_of_16(context: Context) -> None:
    """The pilot renders 64 samples; one block of 64 has no error."""
    settings = Settings(width=8, height=8)
    expected = particles_worth(load(BALL), settings, context)
    found = particles_worth(load(BALL), settings_for(settings, sampler="sobol64"), context)
    assert expected
    assert found
    assert found.gain == expected.gain
    assert found.settings == settings_for(expected.settings, sampler="sobol64")


def test_the_frame_of_the_pilot_is_the_whole_one() -> None:
    wanted = Settings(width=600, height=400, crop=(1, 2, 3, 4), aov=("depth",), seed=5)
    small = caustics._small(wanted, 2400)
    assert (small.size, small.aov, small.seed) == ((60, 40), (), caustics.SEED)
    thin = caustics._small(Settings(width=16384, height=1), 4096)
    assert thin.size == (8192, 1)


def test_a_pilot_is_a_small_share_of_a_render() -> None:
    """Its four pictures take at most 4 / LEAST of the samples; short renders have small pilots."""
    scene = load("cornell")  # 512 x 512 pixels, 256 samples
    sizes = {256: caustics.LONG, 128: caustics.LONG, 64: caustics.SHORT, 32: caustics.SHORT, 31: 0}
    for samples, pixels in sizes.items():
        settings = settings_for(scene.render, samples=samples)
        assert caustics._pilot_of(settings, samples) == pixels
        assert may_gain(scene, settings) == (pixels > 0)
    assert not may_gain(scene, settings_for(scene.render, width=64, height=64))
    assert may_gain(scene, settings_for(scene.render, samples=31, width=2048, crop=(0, 0, 9, 9)))


@pytest.mark.parametrize(
    ("given", "has_links", "tried"),
    [
        ({}, True, CHOICES[2]),
        ({}, False, CHOICES[0]),
        ({"linked": 0.0}, True, CHOICES[0]),
        ({"particles": 0.3}, True, {**CHOICES[2], "particles": 0.3}),
    ],
    ids=str,
)
def test_a_short_pilot_tries_one_choice(
    given: dict[str, float], has_links: bool, tried: dict[str, float]
) -> None:
    assert caustics._choices(given, has_links, is_short=True) == [tried]


@pytest.mark.parametrize(("error", "pixels"), [(None, 64), (0.02, 64), (0.04, 16), (0.5, None)])
def test_the_error_that_is_wanted_reports_how_long_a_render_is(
    error: float | None, pixels: int | None, context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its samples by the plain picture: here 2,500, 625, and 4, where 880 and 160 have a pilot."""
    sizes: list[int] = []
    monkeypatch.setattr(caustics, "LONG", 64)
    monkeypatch.setattr(caustics, "SHORT", 16)

    def picture(*given: Any) -> None:
        sizes.append(given[-1])

    def gain(*given: Any) -> float:
        sizes.append(given[-1])
        return 2.0

    monkeypatch.setattr(caustics, "_picture", picture)
    monkeypatch.setattr(caustics, "_gain", gain)
    monkeypatch.setattr(caustics, "_samples_to", lambda error, _: 1 / error**2)
    settings = Settings(width=32, height=16, samples=1 << 20)
    found = particles_worth(load(BALL), settings, context, error=error)
    assert (found is None) == (pixels is None)
    assert sizes[-1] == (pixels or 64)


@pytest.mark.slow
def test_an_error_that_few_samples_reach_is_not_worth_a_choice(context: Context) -> None:
    scene = load(BALL)
    settings = settings_for(scene.render, width=24, height=24, samples=1 << 20)
    assert may_gain(scene, settings)
    assert particles_worth(scene, settings, context, error=1.0) is None
    assert particles_worth(scene, settings, context, error=0.001) is not None


@pytest.mark.slow
def test_a_small_sun_in_an_image_of_the_sky_gets_particles(context: Context) -> None:
    """The sky is the only light: particles of a smooth one lose, those of a small sun win."""
    scene = sun_map()
    settings = settings_for(scene.render, width=64, height=64, samples=1 << 20)
    assert may_gain(scene, settings)
    found = particles_worth(scene, settings, context)
    assert found
    assert found.settings.caustics == "on"
    assert found.gain > 2
    even = particles_worth(even_sky(), settings, context)
    assert even
    assert even.settings.caustics == "off"
