"""Random numbers that pixels share: the map between neighbours, on noise whose truth is known."""

from collections.abc import Callable

import numpy as np
import pytest

from bench.program import parser_of
from bench.shared import RENDERS, WAYS, Way, boxes, measure, picture_of, regions_of
from glrt.gpu.context import Context

SIZE = 16
ONE_OBJECT = np.zeros((SIZE, SIZE), np.int64)
Draw = Callable[[tuple[int, ...]], np.ndarray]


def renders_of(draw: Draw, alike: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """C and P about a mean of 1; the variance of C is a share `alike` the same in all pixels."""
    shape = RENDERS, SIZE, SIZE, 3
    common = np.sqrt(alike) * draw((RENDERS, 1, 1, 3)) + np.sqrt(1 - alike) * draw(shape)
    return 1 + common, 1 + draw(shape)


@pytest.fixture
def few_boxes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Small boxes alone, which take less time."""
    monkeypatch.setattr("bench.shared.RADII", (1,))
    monkeypatch.setattr("bench.shared.BOXES", (0, 1))


def normal(seed: int) -> Draw:
    """Normal noise."""
    rng = np.random.default_rng(seed)
    return lambda shape: rng.normal(scale=0.1, size=shape)


def test_a_box_averages_one_object_up_to_the_edge() -> None:
    objects = np.array([[1, 1, 2], [1, 2, 2]])
    values = np.array([[1.0, 3.0, 10.0], [5.0, 20.0, 30.0]])[..., None]
    same, near = boxes(values, (0, 1), objects)
    assert near[..., 0].tolist() == [[3, 3, 20], [3, 20, 20]]
    assert np.array_equal(same, values)


def test_a_region_is_of_one_object_and_one_tile() -> None:
    assert regions_of(np.array([[7, 7, 7, 9]]), tile=2).tolist() == [[0, 0, 1, 2]]


@pytest.mark.parametrize("way", WAYS)
def test_a_picture_without_noise_stays_to_the_bit(way: str) -> None:
    rng = np.random.default_rng(1)
    row = rng.integers(0, 64, (SIZE, SIZE, 3)) / 8  # sums of these are exact
    truth = np.broadcast_to(row, (RENDERS, SIZE, SIZE, 3)).copy()
    found = picture_of(truth, truth, rng.integers(0, 3, (SIZE, SIZE)), way)
    assert np.array_equal(found.radiance, row)
    assert not found.stderr.any()


def test_noise_of_all_pixels_alike_goes_into_the_widest_box() -> None:
    """The noise that remains is that of P's mean over 81 pixels or more."""
    common, own = renders_of(normal(2))
    plain = np.square((common + own).mean(axis=0) / 2 - 1).mean()
    for way in WAYS:
        found = picture_of(common, own, ONE_OBJECT, way)
        assert np.square(found.radiance - 1).mean() < plain / 20


def test_a_radius_of_zero_is_the_mean_of_both_kinds() -> None:
    """Neighbours do not err alike, so that a box of C would only add noise."""
    common, own = renders_of(normal(3), alike=0.0)
    found = picture_of(common, own, ONE_OBJECT, "radius")
    assert np.allclose(found.radiance, (common + own).mean(axis=0) / 2, rtol=1e-14, atol=0)


@pytest.mark.parametrize("alike", [0.0, 0.5, 0.9])
def test_the_estimated_error_is_the_true_one(alike: float, few_boxes: None) -> None:
    """Over 60 pictures of 768 values that share noise with neighbours: known to 1 or 2 %."""
    draw = normal(4)
    pictures = [picture_of(*renders_of(draw, alike), ONE_OBJECT, "weights") for _ in range(60)]
    true = np.mean([np.square(it.radiance - 1).mean() for it in pictures])
    told = np.mean([np.square(it.stderr).mean() for it in pictures])
    assert np.sqrt(told / true) == pytest.approx(1, abs=0.05)


def test_only_weights_from_the_other_half_are_unbiased(few_boxes: None) -> None:
    """Skewed noise, and regions of four pixels: weights from a half's own samples darken it.

    Over 60 pictures, with a limit of 4.5 standard errors: false alarms have a chance of 1e-5.
    """

    def distance(fits_own: bool) -> float:
        rng = np.random.default_rng(5)
        objects = np.arange(SIZE * SIZE).reshape(SIZE, SIZE) // 4
        means = []
        for _ in range(60):
            common, own = 1 + rng.exponential(size=(2, RENDERS, SIZE, SIZE, 1)) ** 2
            means.append(picture_of(common, own, objects, "weights", fits_own).radiance.mean())
        return float((np.mean(means) - 3) / (np.std(means, ddof=1) / np.sqrt(len(means))))

    assert abs(distance(fits_own=False)) < 4.5
    assert distance(fits_own=True) < -4.5


def test_a_scene_is_measured(context: Context) -> None:
    parsed = parser_of("shared", None).parse_args([])
    parsed.size, parsed.rounds, parsed.samples = 8, 2, 256
    ways, pictures = measure(context, "sky", parsed)
    assert all(isinstance(way, Way) and way.gain > 0 and way.told > 0 for way in ways)
    assert [picture.shape for picture in pictures] == [(8, 8, 3)] * (1 + len(WAYS))
    assert str(Way(1.5, 1.0, (0.9, 1.1))) == "1.50 | 1.000 (0.90 to 1.10)"
