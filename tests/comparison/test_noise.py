"""The effect of chance on a difference, against exact numbers where there are any."""

import math
from itertools import combinations
from statistics import NormalDist

import numpy as np
import pytest

from glrt.comparison.noise import Judge, Pair, Sums, even_weights
from glrt.comparison.regions import blocks, edges, whole


def test_variance_is_that_of_all_ways_to_deal_the_samples_out() -> None:
    """Averaged over all ways, it is too large by one part in the number of samples."""
    values, few = np.array([0.0, 0.0, 5.0, 0.3, 0.2, 1.0, 0.0]), 2
    differences, variances = [], []
    for chosen in combinations(range(len(values)), few):
        parts = values[list(chosen)], np.delete(values, chosen)
        a, b = (np.full((1, 1, 3), part.mean()) for part in parts)
        va, vb = (np.full((1, 1, 3), part.var(ddof=1) / len(part)) for part in parts)
        pair = Pair(a, b, va, vb, len(parts[0]), len(parts[1]), alike=True)
        differences.append(pair.difference[0, 0, 0])
        variances.append(pair.shuffled_variance[0, 0, 0])
    assert np.mean(differences) == pytest.approx(0, abs=1e-12)
    exact = np.mean(np.square(differences))
    assert np.mean(variances) == pytest.approx(exact * (1 + 1 / len(values)))


def test_weights_do_not_know_how_the_samples_were_dealt_out() -> None:
    """Hits on the left all in one picture, on the right in the other: nothing changes."""
    draw = np.random.default_rng(1)
    samples = draw.exponential(size=(80, 16, 16, 3)) + 100 * (draw.random((80, 16, 16, 3)) < 2e-3)
    dealt = np.sort(samples, axis=0)
    dealt[:, :, 8:] = dealt[::-1, :, 8:]
    weights = []
    for part in (samples, dealt):
        a, b = part[:16], part[16:]
        va, vb = (p.var(axis=0, ddof=1) / len(p) for p in (a, b))
        weights.append(even_weights(Pair(a.mean(axis=0), b.mean(axis=0), va, vb, 16, 64, True)))
    assert np.allclose(weights[0], weights[1], rtol=0.1)
    assert weights[0].min() < 0.7 * weights[0].max()


def test_lamps_in_view_have_no_weight() -> None:
    """Their rounding noise would give them all of it, and hide a factor of the other light."""
    level, noise = np.ones((16, 16, 3)), np.full((16, 16, 3), 1e-4)
    noise[:, :8] = 1e-14
    factor = np.where(np.arange(16) < 8, 1.0, 1.1)[None, :, None]
    pair = Pair(level * factor, level, noise, noise, 64, 64, alike=True)
    weights = even_weights(pair)
    assert not weights[:, :8].any()
    assert (weights[:, 8:] > 0).all()
    flat = Pair(level, level, noise * 0, noise * 0, 64, 64, alike=True)
    assert (even_weights(flat) > 0).all()


def test_a_few_hits_too_many_are_no_proof() -> None:
    """A block of 4,096 samples a pixel has 26 hits, one of 64 has 3: once in 125 by chance."""
    image, reference = np.zeros((8, 8, 3)), np.zeros((8, 8, 3))
    image.reshape(64, 3)[:3] = 1 / 64
    reference.reshape(64, 3)[:26] = 1 / 4096
    pair = Pair(image, reference, image**2, reference**2, 64, 4096, alike=True)
    assert (Sums(pair, blocks).score > 1.5).all()
    assert (Sums(pair, blocks).score < NormalDist().inv_cdf(1 - 1 / 125)).all()
    turned = Pair(reference, image, reference**2, image**2, 4096, 64, alike=True)
    assert np.allclose(Sums(turned, blocks).score, -Sums(pair, blocks).score)


@pytest.mark.parametrize("expected", [0.1, 0.4, 2.0, 10.0, 100.0])
def test_scores_bound_the_tail_of_rare_hits(expected: float) -> None:
    """The exact chance of so many hits, against exp(-score^2 / 2)."""
    hits = np.arange(400)
    logs = hits * math.log(expected) - expected - np.array([math.lgamma(k + 1) for k in hits])
    tail = np.exp(logs)[::-1].cumsum()[::-1]
    skew = np.full(400, 1 / (3 * math.sqrt(expected)))
    judge = Judge(np.full(400, math.sqrt(expected)), skew, skew)
    score = judge.score(np.asarray(hits - expected, np.float64))
    above = (score > 0) & (tail > 1e-250)
    assert above.sum() > 20
    assert (tail[above] <= np.exp(-(score[above] ** 2) / 2)).all()


def test_reach_is_the_difference_that_scores_so_much() -> None:
    judge = Judge(np.array([0.5, 2.0, 1.0]), np.array([0.0, 0.3, 4.0]), np.zeros(3))
    assert np.allclose(judge.score(judge.reach(4.2)), 4.2)
    silent = Judge(np.ones(1), np.array([np.inf]), np.zeros(1))
    assert silent.score(np.array([1e6])) == 0
    assert silent.score(np.array([-3.0])) == -3
    assert np.isinf(silent.reach(1.0))


@pytest.mark.parametrize(
    ("length", "starts"), [(1, [0, 1]), (8, [0, 8]), (15, [0, 15]), (21, [0, 8, 21])]
)
def test_every_pixel_is_in_a_block(length: int, starts: list[int]) -> None:
    assert edges(length).tolist() == starts
    assert blocks(np.ones((length, 9, 3))).sum() == length * 9 * 3


def test_hits_that_the_darker_picture_missed_are_weighed_between_methods() -> None:
    """It saw 20 hits where 45 were due: as unlikely as 4.2 standard errors, not 25 / sqrt(20)."""
    image, quiet = np.zeros((8, 8, 3)), np.zeros((8, 8, 3))
    image.reshape(64, 3)[:20] = 1.0
    pair = Pair(image, quiet + 45 / 64, image.copy(), quiet, 256, 256, alike=False)
    score = Sums(pair, blocks).score
    assert (score > -4.3).all()
    assert (score < -4.0).all()


def test_a_block_whose_noise_stands_in_a_few_pixels_has_no_vote_between_methods() -> None:
    """The darker picture may have missed hits of the size that it saw."""
    variance, calm = np.zeros((8, 8, 3)), np.full((8, 8, 3), 1e-4)
    variance[2, 2:5] = 1.0
    level = np.zeros((8, 8, 3))
    darker = Pair(level, level + 1, variance, calm, 64, 64, alike=False)
    assert (Sums(darker, whole).score == 0).all()
    brighter = Pair(level + 1, level, variance, calm, 64, 64, alike=False)
    assert (Sums(brighter, whole).score > 4).all()


@pytest.mark.parametrize(("variances", "noise"), [((1, 1e-9), 8), ((1e-9, 1), 32)])
def test_what_would_be_found_takes_the_larger_noise_of_both_judges(
    variances: tuple[float, float], noise: float
) -> None:
    """4 samples against 64: shuffled, the first variance is a 16th, the second 16 times as much."""
    level = np.ones((8, 8, 3))
    a, b = (np.full(level.shape, variance) for variance in variances)
    sums = Sums(Pair(level, level, a, b, 4, 64, alike=False), whole)
    likely, even = (sums.factor_found(level, 4, power) for power in (0.95, 0.5))
    assert np.allclose(likely - even, NormalDist().inv_cdf(0.95) * noise / 64)


def test_rare_light_that_was_met_anywhere_may_have_been_missed_anywhere() -> None:
    """One hit in 24 blocks: each of the others may have missed a 24th of its variance."""
    variance = np.full((32, 48, 3), 1e-8)
    calm = variance.copy()
    variance[11, 20] = 0.5
    level = np.ones_like(variance)
    dark = Pair(level, level + 1e-3, variance, calm, 256, 256, alike=False)
    score = Sums(dark, blocks).score
    assert (np.abs(score) < 1).all()
    alone = Pair(level, level + 1e-3, calm, calm, 256, 256, alike=False)
    assert (Sums(alone, blocks).score < -30).all()


def test_rare_light_counts_once_for_the_whole_picture() -> None:
    """All that was met is in the variance of its sum already."""
    variance = np.full((32, 48, 3), 1e-6)
    variance[::8, ::8] = 1.0
    level = np.ones_like(variance)
    pair = Pair(level, level, variance, np.full_like(variance, 1e-6), 256, 256, alike=False)
    noise = Sums(pair, whole).factor_found(level, 0.0, 0.5 + 0.3413447)
    assert np.allclose(noise - 1e-5, math.sqrt(24) / 1536, rtol=1e-3)
