"""A picture is judged by what its scene tells: lamps in view, and light that glass may gather.

The pictures are made by hand; tests/error/test_reliability.py has rendered ones.
"""

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.error.judgement import ALBEDO, judged, spark
from glrt.error.reliability import RARE, is_doubtful
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.error.test_seen_lamps import BALL, EMISSION, SIZE, SKY, found, scene

SAMPLES = 256
NOISE = 0.01  # standard error over radiance of the even part of a picture
FLOOR = {"shape": "plane", "point": [0, -50, 0], "normal": [0, 1, 0], "material": "matte"}
MARBLE = {"shape": "sphere", "center": [0, -30, 0], "radius": 1, "material": "glass"}
SMALL = {**BALL, "center": [0, 30, 0]}  # out of view
Pixels = NDArray[np.float32]


def even(size: int = SIZE) -> tuple[Pixels, Pixels]:
    """Radiance and standard error of the sky alone, with a little noise."""
    radiance = np.full((size, size, 3), SKY, np.float32)
    return radiance, np.float32(NOISE) * radiance


def with_rim(shown: float, error: float) -> tuple[Pixels, Pixels]:
    """The same with a pixel in the middle that shows so much of a lamp, with so large an error."""
    radiance, stderr = even()
    middle = SIZE // 2
    radiance[middle, middle], stderr[middle, middle] = shown, error
    return radiance, stderr


def verdict(made: Scene, picture: tuple[Pixels, Pixels], **settings: Any) -> bool | None:
    size = len(picture[0])
    return judged(made, Settings(width=size, height=size, **settings), SAMPLES, *picture)


def test_a_lamp_that_was_met_too_often_or_too_rarely_is_known() -> None:
    truth = float(found(scene(BALL)).radiance[0, 0])
    by_luck, twice, missed = (
        with_rim(truth, truth),
        with_rim(4 * truth, 4 * truth),
        with_rim(SKY, NOISE * SKY),
    )
    lucky = is_doubtful(*by_luck, 16)
    assert lucky is True, "by statistics alone nobody knows"
    assert verdict(scene(BALL), by_luck) is False
    assert verdict(scene(BALL), twice) is True
    assert is_doubtful(*missed, 16) is False, "a lamp that no sample met is in no statistics"
    assert verdict(scene(BALL), missed) is True
    assert verdict(scene(), missed) is False


def test_what_is_known_of_a_lamp_does_not_excuse_other_pixels() -> None:
    truth = float(found(scene(BALL)).radiance[0, 0])
    radiance, stderr = with_rim(truth, truth)
    radiance[1, 1] = stderr[1, 1] = 40.0
    assert verdict(scene(BALL), (radiance, stderr)) is True


def test_a_spark_is_as_bright_as_one_sample_that_meets_the_lamp() -> None:
    radiance, _ = even()
    made = scene(SMALL, MARBLE, FLOOR)
    assert spark(made, SAMPLES, radiance) == pytest.approx(ALBEDO * EMISSION / SAMPLES / SKY)
    assert spark(made, SAMPLES, 2 * radiance) == pytest.approx(
        ALBEDO * EMISSION / SAMPLES / SKY / 2
    )
    assert spark(made, SAMPLES, 0 * radiance) == math.inf
    for kept in ((SMALL, MARBLE), (SMALL, FLOOR), (MARBLE, FLOOR)):
        assert spark(scene(*kept), SAMPLES, radiance) == 0


def test_glass_under_a_small_lamp_is_doubted_where_one_spark_would_rule_the_error() -> None:
    bright = {"emission": [2 * RARE * SKY * SAMPLES / ALBEDO] * 3}
    dim = {"emission": [0.5 * RARE * SKY * SAMPLES / ALBEDO] * 3}
    objects = (SMALL, MARBLE, FLOOR)
    assert verdict(scene(*objects, lamp=bright), even()) is True
    assert verdict(scene(*objects, lamp=dim), even()) is False
    assert verdict(scene(SMALL, FLOOR, lamp=bright), even()) is False, "no glass"
    radiance, stderr = even()
    noisy = (radiance, 30 * stderr)
    assert verdict(scene(*objects, lamp=bright), noisy) is False, "one pixel is not much there"


def test_few_observations_are_not_judged() -> None:
    picture = with_rim(SKY, NOISE * SKY)
    wanted = Settings(width=SIZE, height=SIZE, sampler="sobol")
    assert judged(scene(BALL), wanted, 63, *picture) is None
    assert judged(scene(BALL), wanted, 64, *picture) is True
    independent = Settings(width=SIZE, height=SIZE, sampler="independent")
    assert judged(scene(BALL), independent, 4, *picture) is True
