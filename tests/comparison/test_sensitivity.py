"""`compare` finds the differences that it claims it would have found.

Seeds are fixed; every statistical test fails by chance once in 10,000 seeds at most.
"""

from dataclasses import replace

import numpy as np
import pytest

from glrt.comparison.noise import Pair
from glrt.comparison.sensitivity import has_noise
from glrt.comparison.verdict import compare
from glrt.image.image import Image
from tests.support.noisy_images import noisy

TRIALS = 100
FEWEST = 80  # of 100 where each is found 9 times in 10: fewer happen once in 1,000 sets at most


def brighter(image: Image, change: np.ndarray) -> Image:
    """The image with `change`, (H, W, 3), added."""
    return replace(image, radiance=image.radiance + change.astype(np.float32))


@pytest.mark.parametrize("kind", ["smooth", "caustic"])
@pytest.mark.parametrize("alike", [True, False])
def test_a_change_of_all_light_is_found_at_its_size(kind: str, alike: bool) -> None:
    found = 0
    for i in range(TRIALS):
        image, reference = noisy(kind, 256, i), noisy(kind, 256, 1000 + i)
        size = compare(image, reference, alike=alike).sensitivity.light
        found += not compare(brighter(image, size * image.radiance), reference, alike=alike)
    assert found >= FEWEST


@pytest.mark.parametrize(
    ("kind", "alike"), [("smooth", True), ("smooth", False), ("caustic", True)]
)
def test_a_change_of_a_block_is_found_at_its_size(kind: str, alike: bool) -> None:
    found = 0
    for i in range(TRIALS):
        image, reference = noisy(kind, 256, i), noisy(kind, 256, 1000 + i)
        size = compare(image, reference, alike=alike).sensitivity.block
        row, column = divmod(i % 16, 4)
        change = np.zeros_like(image.radiance)
        place = np.s_[8 * row : 8 * row + 8, 8 * column : 8 * column + 8]
        change[place] = size * image.radiance[place]
        found += not compare(brighter(image, change), reference, alike=alike)
    assert found >= FEWEST


def test_a_change_of_a_light_group_is_found_at_its_size() -> None:
    """A lamp that lights the left half a little."""
    lamp = np.zeros((32, 32, 3), np.float32)
    lamp[:, :16] = 0.1
    part = Image(lamp, np.zeros_like(lamp), 64)
    found, sizes = 0, []
    for i in range(TRIALS):
        image, reference = noisy("smooth", 256, i), noisy("smooth", 256, 1000 + i)
        result = compare(image, reference, alike=True, groups={"lamp": part})
        sizes.append(result.sensitivity.groups["lamp"])
        assert sizes[-1] > 3 * result.sensitivity.light
        found += not compare(brighter(image, sizes[-1] * lamp), reference, alike=True)
    assert found >= FEWEST


def test_a_group_whose_change_would_not_show_keeps_the_verdict_open() -> None:
    image, reference = noisy("smooth", 256, 1), noisy("smooth", 256, 2)
    assert compare(image, reference, alike=True).verdict == "same"
    faint = replace(image, radiance=0.01 * image.radiance)
    found = compare(image, reference, alike=True, groups={"candle": faint})
    assert found.verdict == "undecided"
    assert "each light" in str(found)
    dark = replace(image, radiance=0 * image.radiance)
    assert compare(image, reference, alike=True, groups={"off": dark}).sensitivity.groups == {}


def test_light_that_the_camera_sees_itself_says_nothing_of_the_rest() -> None:
    """Half of the picture is sky, with a thousandth of the noise."""
    image, reference = noisy("smooth", 64, 1), noisy("smooth", 64, 2)
    plain = compare(image, reference, alike=True).sensitivity.light
    sky = (np.arange(32) < 16)[:, None, None]
    pair = [
        replace(
            i,
            radiance=np.where(sky, 1 + 1e-3 * (i.radiance - 0.5), i.radiance).astype(np.float32),
            stderr=np.where(sky, 1e-3 * i.stderr, i.stderr).astype(np.float32),
        )
        for i in (image, reference)
    ]
    with_sky = compare(pair[0], pair[1], alike=True).sensitivity.light
    assert 0.7 * plain < with_sky < 3 * plain


def test_a_picture_without_noise_is_all_light() -> None:
    level, none = np.ones((8, 8, 3)), np.zeros((8, 8, 3))
    assert has_noise(Pair(level, level, none, none, 64, 64, True)).all()
