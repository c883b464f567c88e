"""Pictures below a chart that show how errors look."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pytest

from glrt.analysis.chart.curves import Curve
from glrt.analysis.chart.sights import Sight, captions, codes_of, sights_of
from glrt.analysis.reference import Reference
from glrt.image.image import Image
from tests.support.charted_curves import made

TRUTH = np.full((24, 24, 3), 0.5)


class Noise:
    """Stands for a Bench: a picture of N samples has a relative error of 1 / sqrt(N)."""

    def __init__(self) -> None:
        """Nothing is asked for yet."""
        self.asked: list[tuple[str, Sequence[int]]] = []

    def pictures(self, name: str, samples: Sequence[int]) -> Iterator[Image]:
        self.asked.append((name, samples))
        signs = np.indices(TRUTH.shape).sum(axis=0) % 2 * 2 - 1
        for count in samples:
            noise = np.sqrt(1.01) * 0.5 * signs / np.sqrt(count)
            yield Image((TRUTH + noise).astype(np.float32), np.zeros_like(TRUTH, np.float32), count)


def curve(name: str, milliseconds: float, bias: float = 0.0) -> Curve:
    """With as many milliseconds a sample."""
    dots = [(milliseconds * 2**n, 1 / np.sqrt(2**n)) for n in range(6)]
    return made(name, *dots, bias=bias)


def sights(*curves: Curve, noise: float = 0.0) -> tuple[Noise, list[Sight], Reference]:
    bench: Any = Noise()
    signs = (-1.0) ** np.indices(TRUTH.shape).sum(axis=0)
    halves = TRUTH + noise * signs, TRUTH - noise * signs
    reference = Reference(*halves, 1, 1)
    return bench, sights_of(bench, curves, reference), reference


def test_each_level_has_a_picture_of_its_error_if_there_is_time() -> None:
    bench, found, _ = sights(curve("slow", 1.0), curve("fast", 0.1), curve("wrong", 1e-3, bias=0.1))
    assert bench.asked == [("fast", [100, 1111, 10000])]
    assert [sight.error for sight in found] == pytest.approx([0.1, 0.03, 0.01], rel=0.01)
    assert {sight.share for sight in found} == {1.0}


def test_errors_that_take_too_long_are_means_with_the_reference() -> None:
    bench, found, reference = sights(curve("only", 2.0))
    assert bench.asked == [("only", [100])]
    assert [sight.share for sight in found] == pytest.approx([1.0, 0.3, 0.1], rel=0.01)
    for sight in found:
        squared = reference.squared_error(sight.radiance)
        assert np.sqrt(squared) == pytest.approx(sight.level, rel=0.01)
    assert captions(found, reference) == [
        "10 %: only, 100 samples",
        "3 %: mixed with the reference",
        "1 %: mixed with the reference",
        "0 %: reference",
    ]


def test_all_are_means_where_even_the_first_takes_too_long() -> None:
    bench, found, _ = sights(curve("only", 60.0))
    assert bench.asked == [("only", [25])]
    assert [sight.share for sight in found] == pytest.approx([0.5, 0.15, 0.05], rel=0.01)


def test_a_reference_with_more_noise_than_a_level_does_not_show_it() -> None:
    _, found, reference = sights(curve("only", 2.0), noise=0.01)
    assert 0.01 < reference.error < 0.02
    assert [sight.level for sight in found] == [0.1, 0.03]
    bench, found, reference = sights(curve("only", 2.0), noise=0.2)
    assert reference.error > 0.1
    assert (bench.asked, found) == ([], [])


def test_biased_and_denoised_variants_show_nothing() -> None:
    bench, found, _ = sights(curve("a", 1.0, bias=0.1), curve("a, denoised by nlm", 1.0))
    assert (bench.asked, found) == ([], [])


def test_large_pictures_show_the_part_with_the_usual_error() -> None:
    """Thirds have little, no and much noise: the part lies across the last two."""
    truth = np.full((100, 300, 3), 0.5)
    radiance = truth.astype(np.float32)
    radiance[:, :100] += 0.05
    radiance[:, 200:] += 0.1
    sight = Sight(0.1, "a", 4, 0.1, radiance)
    codes, last = codes_of([sight], Reference(truth, truth, 1, 1))
    assert codes.shape == last.shape == (96, 96, 3)
    noisy = (codes != last).all(axis=(0, 2))
    assert noisy.tolist() == [False] * 56 + [True] * 40
