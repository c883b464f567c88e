"""A picture is judged by the lamps in view, as its scene describes them.

The pictures are made by hand; tests/error/test_reliability.py has rendered ones.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.error.reliability import is_doubtful
from glrt.error.reliability_of_scene import judged
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.error.test_seen_lamps import BALL, SIZE, SKY, found, scene

SAMPLES = 256
NOISE = 0.01  # standard error over radiance of the even part of a picture
Pixels = NDArray[np.float32]


def even(size: int = SIZE) -> tuple[Pixels, Pixels]:
    """Radiance and standard error of the sky alone, with a little noise."""
    radiance = np.full((size, size, 3), SKY, np.float32)
    return radiance, np.float32(NOISE) * radiance


def with_rim(shown: float, error: float, beside: float = SKY) -> tuple[Pixels, Pixels]:
    """The same with a pixel in the middle that shows so much of a lamp, with so large an error.

    The pixel next to it has a certain light.
    """
    radiance, stderr = even()
    middle = SIZE // 2
    radiance[middle, middle], stderr[middle, middle] = shown, error
    radiance[middle, middle + 1] = beside
    return radiance, stderr


def verdict(made: Scene, picture: tuple[Pixels, Pixels], **settings: Any) -> bool | None:
    size = len(picture[0])
    return judged(made, Settings(width=size, height=size, **settings), SAMPLES, *picture)


def test_a_lamp_that_was_met_too_often_or_too_rarely_is_known() -> None:
    truth = float(found(scene(BALL)).radiance[0, 0])
    by_luck, twice, missed = (
        with_rim(truth, truth, beside=0.4 * truth),
        with_rim(4 * truth, 4 * truth, beside=5 * truth),
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
    radiance, stderr = with_rim(truth, truth, beside=0.9 * truth)
    radiance[1, 1] = stderr[1, 1] = 40.0
    radiance[1, 2] = 19.0
    assert verdict(scene(BALL), (radiance, stderr)) is True


def test_few_observations_are_not_judged() -> None:
    picture = with_rim(SKY, NOISE * SKY)
    wanted = Settings(width=SIZE, height=SIZE, sampler="sobol")
    assert judged(scene(BALL), wanted, 63, *picture) is None
    assert judged(scene(BALL), wanted, 64, *picture) is True
    independent = Settings(width=SIZE, height=SIZE, sampler="independent")
    assert judged(scene(BALL), independent, 4, *picture) is True
