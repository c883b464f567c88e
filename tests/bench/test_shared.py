"""`bench.shared`: the gain of random numbers that pixels share."""

import numpy as np
import pytest

from bench.program import parser_of
from bench.shared import Gain, judged, measure
from glrt.gpu.context import Context
from glrt.image.image import Image


def image_of(value: float, stderr: float) -> Image:
    return Image(np.full((2, 2, 3), value, np.float32), np.full((2, 2, 3), stderr, np.float32), 256)


def test_gains_are_ratios_of_squared_errors() -> None:
    plain = [image_of(value, 1.0) for value in (8, 12)]
    shared = [image_of(value, 1.5) for value in (9, 11)]
    gain = judged(plain, shared, speed=0.5)
    assert gain.variance == pytest.approx(4)
    assert gain.told == pytest.approx(1.5 / np.sqrt(2))
    assert str(gain) == "4.00 | 0.50 | 2.00 | 1.06 (1.06 to 1.06) | 0.00"


def test_means_that_differ_are_found() -> None:
    """By 3 standard errors in all blocks; without a difference by about 1."""
    rng = np.random.default_rng(1)
    rows = rng.normal(size=(2, 200, 16, 16, 1)) + np.zeros(3)

    def found(shift: float) -> float:
        plain, shared = (
            [Image(it, it, 256) for it in some.astype(np.float32)]
            for some in (rows[0], rows[1] + shift)
        )
        return judged(plain, shared, speed=1.0).apart

    assert found(0.0) < 2
    assert found(3 * np.sqrt(2 / 200) / 8) == pytest.approx(3, abs=1.5)


def test_a_scene_is_measured(context: Context) -> None:
    parsed = parser_of("shared", None).parse_args([])
    parsed.size, parsed.rounds, parsed.samples = 8, 2, 256
    parsed.caustics, parsed.sampler = "off", "shared"
    gain, pictures = measure(context, "sky", parsed)
    assert isinstance(gain, Gain)
    assert gain.variance > 0
    assert gain.told > 0
    assert [picture.shape for picture in pictures] == [(8, 8, 3)] * 2
