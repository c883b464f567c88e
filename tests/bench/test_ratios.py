"""Intervals of ratios: they hold the truth as often as promised, and decide what they can."""

import numpy as np
import pytest
from numpy.typing import NDArray

from bench.ratios import LEAST_ROUNDS, Ratio, rank_of, ratio_of, ratio_over
from tests.support.alarms import book

ROUNDS = 30


def times(seed: int, factor: float = 1.0, noise: float = 0.02) -> tuple[list[float], list[float]]:
    """Times of two programs in rounds of unlike speed; the first takes `factor` times as long."""
    rng = np.random.default_rng(seed)

    def noisy() -> NDArray[np.float64]:
        return rng.lognormal(0, noise, ROUNDS)

    speed = rng.lognormal(0, 0.5, ROUNDS)
    return (factor * speed * noisy()).tolist(), (speed * noisy()).tolist()


def test_the_rank_is_the_one_of_tables() -> None:
    assert [rank_of(rounds) for rounds in (6, 8, 9, 10, 20, 30, 100)] == [1, 1, 2, 2, 6, 10, 40]
    assert rank_of(LEAST_ROUNDS) == 1
    with pytest.raises(ValueError, match="6 or more"):
        rank_of(LEAST_ROUNDS - 1)


def test_equal_programs_have_an_interval_around_one() -> None:
    """One scene's does in 95 % of cases or more: fewer than 170 of 200 are hardly chance."""
    found = [ratio_of(*times(seed)) for seed in range(200)]
    assert sum(ratio.low <= 1 <= ratio.high for ratio in found) >= 170
    whole = [ratio_over([times(7 * seed + n) for n in range(6)]) for seed in range(30)]
    assert sum(ratio.low <= 1 <= ratio.high for ratio in whole) >= 20
    book(2)


def test_more_scenes_make_the_interval_narrower() -> None:
    one = ratio_over([times(0)])
    six = ratio_over([times(seed) for seed in range(6)])
    assert (six.high - six.low) < 0.7 * (one.high - one.low)


def test_a_program_that_takes_a_fifth_longer_is_slower() -> None:
    ratio = ratio_of(*times(1, 1.2))
    assert ratio.low < 1.2 < ratio.high
    assert ratio.verdict == ratio_over([times(n, 1.2) for n in range(3)]).verdict == "slower"


def test_a_scene_counts_no_more_for_being_disturbed() -> None:
    these, others = times(2)
    disturbed = [3 * taken if n % 3 == 0 else taken for n, taken in enumerate(these)]
    assert ratio_over([times(3), (disturbed, others)]).value == pytest.approx(1, abs=0.03)


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [
        (0.9, 1.02, "no slower"),
        (1.01, 1.02, "no slower"),
        (1.01, 1.2, "slower"),
        (0.99, 1.03, "not decided: more rounds"),
        (1.0, 1.2, "not decided: more rounds"),
    ],
)
def test_the_interval_decides(low: float, high: float, verdict: str) -> None:
    assert Ratio(1.0, low, high).verdict == verdict


def test_a_ratio_is_written_with_its_interval() -> None:
    assert str(Ratio(1.0, 0.98765, 1.02)) == "1.000 (0.988-1.020)"
