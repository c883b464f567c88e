"""Random numbers that pixels share: the map between neighbours, on noise whose truth is known."""

from collections.abc import Callable

import numpy as np
import pytest

from glrt.image.shared_numbers import PAIRS, STRIP, boxes, combined, own_part, regions_of

SIZE = 16
ONE_OBJECT = np.zeros((SIZE, SIZE), np.int64)
Draw = Callable[[tuple[int, ...]], np.ndarray]


def net_of(common: np.ndarray, own: np.ndarray, count: float = 16) -> np.ndarray:
    """Groups of equal counts, (2 PAIRS, H, W, 4): C and P by turns."""
    means = np.stack([common, own], axis=1).reshape(2 * len(own), *own.shape[1:])
    means = np.broadcast_to(means, (*means.shape[:3], 3))
    return np.concatenate([means, np.full((*means.shape[:3], 1), count)], -1).astype(np.float32)


def noisy(draw: Draw, alike: float = 1.0, size: tuple[int, int] = (SIZE, SIZE)) -> np.ndarray:
    """Groups about a mean of 1; the variance of C is a share `alike` the same in all pixels."""
    shape = PAIRS, *size, 3
    common = np.sqrt(alike) * draw((PAIRS, 1, 1, 3)) + np.sqrt(1 - alike) * draw(shape)
    return net_of(np.broadcast_to(1 + common, shape), 1 + draw(shape))


@pytest.fixture
def few_boxes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Small boxes alone, which take less time."""
    monkeypatch.setattr("glrt.image.shared_numbers.BOXES", (0, 1))


def normal(seed: int) -> Draw:
    """Normal noise."""
    rng = np.random.default_rng(seed)
    return lambda shape: rng.normal(scale=0.1, size=shape)


def test_a_box_averages_one_object_up_to_the_edge() -> None:
    objects = np.array([[1, 1, 2], [1, 2, 2]])
    values = np.array([[[1.0, 3.0, 10.0], [5.0, 20.0, 30.0]]])
    same, near = boxes(values, (0, 1), objects)
    assert near[0].tolist() == [[3, 3, 20], [3, 20, 20]]
    assert np.array_equal(same, values)


def test_boxes_are_means_over_the_pixels_of_an_object_in_a_square() -> None:
    rng = np.random.default_rng(7)
    objects, values = rng.integers(0, 4, (9, 13)), rng.normal(size=(2, 3, 9, 13))
    found = boxes(values, (0, 1, 3), objects)
    for number, radius in enumerate((0, 1, 3)):
        for y, x in ((0, 0), (4, 6), (8, 12), (2, 11)):
            place = (
                slice(max(y - radius, 0), y + radius + 1),
                slice(max(x - radius, 0), x + radius + 1),
            )
            is_own = objects[place] == objects[y, x]
            truth = values[..., *place][..., is_own].mean(axis=-1)
            np.testing.assert_allclose(found[number, ..., y, x], truth, rtol=1e-12)


def test_a_region_is_of_one_object_and_one_tile() -> None:
    assert regions_of(np.array([[7, 7, 7, 9]]), tile=2).tolist() == [[0, 0, 1, 2]]


def test_a_picture_without_noise_stays_to_the_bit() -> None:
    rng = np.random.default_rng(1)
    row = rng.integers(0, 64, (SIZE, SIZE, 3)) / 8  # sums of these are exact
    truth = np.broadcast_to(row, (PAIRS, SIZE, SIZE, 3))
    found = combined(net_of(truth, truth), rng.integers(0, 3, (SIZE, SIZE)))
    assert np.array_equal(found.radiance, row)
    assert not found.stderr.any()


def test_noise_of_all_pixels_alike_goes_into_the_widest_box() -> None:
    """The noise that remains is that of P's mean over 81 pixels or more."""
    net = noisy(normal(2))
    plain = np.square(net[..., :3].mean(axis=0) - 1).mean()
    found = combined(net, ONE_OBJECT)
    assert np.square(found.radiance - 1).mean() < plain / 20


def test_rows_do_not_depend_on_where_the_picture_is_cut(monkeypatch: pytest.MonkeyPatch) -> None:
    net = noisy(normal(8), 0.8, (2 * STRIP + 5, 6))
    objects = np.arange(2 * STRIP + 5)[:, None] // 50 + np.zeros(6, np.int64)
    in_strips = combined(net, objects)
    monkeypatch.setattr("glrt.image.shared_numbers.STRIP", 4 * STRIP)
    whole = combined(net, objects)
    np.testing.assert_allclose(in_strips.radiance, whole.radiance, rtol=1e-6)
    np.testing.assert_allclose(in_strips.stderr, whole.stderr, rtol=1e-5)


@pytest.mark.parametrize("alike", [0.0, 0.5, 0.9])
def test_the_estimated_error_is_the_true_one(alike: float, few_boxes: None) -> None:
    """Over 60 pictures of 768 values that share noise with neighbours: known to 1 or 2 %."""
    draw = normal(4)
    pictures = [combined(noisy(draw, alike), ONE_OBJECT) for _ in range(60)]
    true = np.mean([np.square(it.radiance.astype(float) - 1).mean() for it in pictures])
    told = np.mean([np.square(it.stderr.astype(float)).mean() for it in pictures])
    assert np.sqrt(told / true) == pytest.approx(1, abs=0.05)


def test_pairs_count_by_their_samples(few_boxes: None) -> None:
    """A pair with three times the samples of others has three times their weight in its half."""
    draw = normal(6)
    net = noisy(draw, 0.0)
    objects = np.arange(SIZE * SIZE).reshape(SIZE, SIZE)  # boxes of one pixel
    net[4:6, ..., 3] *= 3
    means = (net[0::2, ..., :3].astype(float) + net[1::2, ..., :3]) / 2
    apart = combined(net, objects).radiance - combined(np.roll(net, 8, axis=0), objects).radiance
    assert np.abs(apart).max() < 1e-6  # pairs may come in any order within a half
    heavy = net.copy()
    heavy[..., 3] = 1e-6
    heavy[4:6, ..., 3] = 1e6
    heavy[6:8, ..., 3] = 1e6
    found = combined(heavy, objects).radiance
    ends = means[2:4].min(axis=0) - 0.3, means[2:4].max(axis=0) + 0.3
    assert ((found > ends[0]) & (found < ends[1])).all()


def test_weights_from_the_other_half_are_unbiased(few_boxes: None) -> None:
    """Skewed noise, and regions of four pixels: weights from a half's own samples would darken it.

    Over 60 pictures, with a limit of 4.5 standard errors: false alarms have a chance of 1e-5.
    """
    rng = np.random.default_rng(5)
    objects = np.arange(SIZE * SIZE).reshape(SIZE, SIZE) // 4
    means = []
    for _ in range(60):
        common, own = 1 + rng.exponential(size=(2, PAIRS, SIZE, SIZE, 1)) ** 2
        means.append(combined(net_of(common, own), objects).radiance.mean())
    apart = (np.mean(means) - 3) / (np.std(means, ddof=1) / np.sqrt(len(means)))
    assert abs(apart) < 4.5


def test_the_own_part_is_of_every_second_group() -> None:
    rng = np.random.default_rng(3)
    net = net_of(rng.normal(size=(PAIRS, 2, 3, 3)), 5 + rng.normal(size=(PAIRS, 2, 3, 3)))
    found = own_part(net)
    values = net[1::2, ..., :3].astype(float)
    np.testing.assert_allclose(found.radiance, values.mean(axis=0), rtol=1e-6)
    error = values.std(axis=0, ddof=1) / np.sqrt(PAIRS)
    np.testing.assert_allclose(found.stderr, error, rtol=1e-5)
