"""Joint non-local means, against a twin in float64 that follows the definition pair by pair."""

import numpy as np
import pytest

from glrt.denoise import nlm
from glrt.denoise.half import Guide, Half
from tests.denoise.noisy_halves import Floats, drawn, truth_with_an_edge

SIZE = (5, 9)


def some_half(seed: int) -> Half:
    rng = np.random.default_rng(seed)
    color, variance = rng.gamma(2, size=(*SIZE, 3)), 0.3 * rng.gamma(2, size=(*SIZE, 3))
    guides = [
        Guide(
            rng.random((*SIZE, 3)).astype(np.float32),
            (0.1 * rng.random((*SIZE, 3))).astype(np.float32),
        )
        for _ in range(2)
    ]
    return Half(color.astype(np.float32), variance.astype(np.float32), 0.5, guides[0], guides[1])


def near(y: int, x: int, reach: int) -> list[tuple[int, int]]:
    return [
        (v, u)
        for v in range(max(0, y - reach), min(SIZE[0], y + reach + 1))
        for u in range(max(0, x - reach), min(SIZE[1], x + reach + 1))
    ]


def twin(half: Half) -> Floats:
    """The filter's twin: each pixel is the mean of its window, weighed pair by pair."""
    color = half.radiance.astype(np.float64)
    noise = np.zeros_like(color)
    for y, x in np.ndindex(SIZE):
        noise[y, x] = np.mean([half.variance[p] for p in near(y, x, nlm.NOISE_REACH)], axis=0)
    result = np.zeros_like(color)
    for y, x in np.ndindex(SIZE):
        weights = {q: weight(half, color, noise, (y, x), q) for q in near(y, x, nlm.REACH)}
        total = sum(w * color[q] for q, w in weights.items())
        result[y, x] = total / sum(weights.values())
    return result


def weight(
    half: Half, color: Floats, noise: Floats, p: tuple[int, int], q: tuple[int, int]
) -> float:
    if p == q:
        return 1.0
    apart = []
    for v, u in near(*p, nlm.PATCH):
        other = v + q[0] - p[0], u + q[1] - p[1]
        if 0 <= other[0] < SIZE[0] and 0 <= other[1] < SIZE[1]:
            a, b = noise[v, u], noise[other]
            square = (color[v, u] - color[other]) ** 2 - 2 * np.minimum(a, b)
            apart.append(np.mean(square / (nlm.COLOR**2 * (a + b) + nlm.NO_NOISE)))
    least = np.exp(-max(np.mean(apart), 0))
    for guide in half.guides:
        mean, variance = guide.mean.astype(np.float64), guide.variance.astype(np.float64)
        spans = [np.maximum(np.maximum(variance[r], slope(mean, r)), nlm.LEAST) for r in (p, q)]
        square = (mean[p] - mean[q]) ** 2 - 2 * np.minimum(variance[p], variance[q])
        distance = np.max(square / (nlm.GUIDE**2 * np.minimum(*spans)))
        least = min(least, np.exp(-max(distance, 0)))
    return float(least)


def slope(mean: Floats, p: tuple[int, int]) -> Floats:
    squares = np.zeros(3)
    for axis in (0, 1):
        there = [tuple(p[k] + step * (k == axis) for k in (0, 1)) for step in (-1, 1)]
        steps = [(mean[q] - mean[p]) ** 2 for q in there if 0 <= q[axis] < SIZE[axis]]
        squares += np.min(steps, axis=0)
    return squares


def test_it_is_the_mean_that_its_definition_gives() -> None:
    half = some_half(0)
    np.testing.assert_allclose(nlm.filtered(half)[0], twin(half), rtol=1e-4, atol=1e-5)


def test_its_own_weight_is_how_a_pixel_follows_itself() -> None:
    """Where weights do not change: with guides alone, as colours that vary by chance are alike."""
    half = some_half(2)
    half = half._replace(variance=np.full_like(half.variance, 1e6))
    before, own = nlm.filtered(half)
    place = 3, 5
    moved = half.radiance.copy()
    moved[place] += 0.5
    after, _ = nlm.filtered(half._replace(radiance=moved))
    np.testing.assert_allclose((after - before)[place], 0.5 * own[place], rtol=1e-3)


def test_even_light_loses_its_noise() -> None:
    truth = np.full((40, 40, 3), 0.5)
    half = drawn(np.random.default_rng(4), truth, (8, 8)).halves[0]
    before = np.square(half.radiance - 0.5).mean()
    after = np.square(nlm.filtered(half)[0] - 0.5).mean()
    assert after < before / 10


def test_light_of_two_surfaces_is_not_mixed() -> None:
    """The guides keep apart what colours with that much noise would not."""
    truth = truth_with_an_edge(20)
    side = np.broadcast_to((np.arange(20) < 10)[None, :, None], truth.shape).astype(np.float64)
    half = drawn(np.random.default_rng(6), truth, (2, 2), guide=side).halves[0]
    dark = half.radiance.copy()
    dark[:, :10] = 0  # nothing of this may reach the right side
    loud = np.full_like(half.variance, 1e4)
    found = nlm.filtered(half._replace(variance=loud))[0]
    again = nlm.filtered(half._replace(radiance=dark, variance=loud))[0]
    np.testing.assert_allclose(found[:, 10:], again[:, 10:], rtol=1e-5)


def test_a_picture_without_noise_stays() -> None:
    truth = np.random.default_rng(8).random((16, 16, 3)).astype(np.float32)
    flat = Guide(*np.zeros((2, *truth.shape), np.float32))
    half = Half(truth, np.zeros_like(truth), 0.5, flat, flat)
    np.testing.assert_allclose(nlm.filtered(half)[0], truth, rtol=1e-4)


@pytest.mark.parametrize("size", [(1, 1), (1, 9), (3, 1), (2, 2)])
def test_small_pictures_are_filtered_too(size: tuple[int, int]) -> None:
    half = drawn(np.random.default_rng(9), np.full((*size, 3), 1.0)).halves[0]
    found, own = nlm.filtered(half)
    assert np.isfinite(found).all()
    assert own.shape == size
