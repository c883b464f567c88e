"""The judges of chance are just: against tables, and on draws that fit or do not."""

import numpy as np
import pytest

from tests.support import alarms
from tests.support.alarms import ALPHA, FEWEST, assert_fits, assert_near, chi_square_tail, pooled


@pytest.mark.parametrize(
    ("degrees", "statistic", "chance"),
    [(2, 5.991, 0.05), (10, 18.307, 0.05), (30, 50.892, 0.01), (100, 149.449, 0.001)],
)
def test_tail_is_that_of_the_tables(degrees: int, statistic: float, chance: float) -> None:
    assert chi_square_tail(statistic, degrees) == pytest.approx(chance, rel=1e-3)
    assert chi_square_tail(statistic, degrees - 1) == chi_square_tail(statistic, degrees)
    assert chi_square_tail(1e6, degrees) == 0
    assert chi_square_tail(0, degrees) == 1


def test_pooling_keeps_every_draw_and_leaves_no_cell_thin() -> None:
    random = np.random.default_rng(1)
    for scale in (0.01, 1, 100):
        wanted = random.exponential(scale, 400)
        found = random.poisson(wanted).astype(float)
        cells, expected = pooled(found, wanted)
        assert cells.sum() == found.sum()
        assert expected.sum() == pytest.approx(wanted.sum())
        assert expected.min() >= min(FEWEST, wanted.sum()) * (1 - 1e-9)
    assert len(pooled(np.arange(9.0), np.full(9, 25.0))[0]) == 9


def test_draws_are_judged_by_their_density() -> None:
    random = np.random.default_rng(2)
    share = random.dirichlet(np.full(200, 2.0))
    counts = random.multinomial(100_000, share)
    assert_fits(counts, 100_000 * share)
    with pytest.raises(AssertionError, match="chi-square"):
        assert_fits(counts, 100_000 * np.roll(share, 1))
    bent = share * np.where(np.arange(200) < 100, 1.08, 0.92)
    with pytest.raises(AssertionError, match="chi-square"):
        assert_fits(counts, 100_000 * bent / bent.sum())


def test_a_draw_where_there_is_no_density_is_refused() -> None:
    with pytest.raises(AssertionError, match="density is 0"):
        assert_fits([50, 49, 1], [50, 50, 0])


def test_a_mean_is_judged_by_its_deviation() -> None:
    assert_near([0.1, -0.2], 0, 0.05)
    with pytest.raises(AssertionError, match=r"6\.00 sigmas"):
        assert_near([0.1, 0.3], 0, 0.05)


def test_verdicts_that_are_given_jointly_share_one_chance(monkeypatch: pytest.MonkeyPatch) -> None:
    booked: list[float] = []
    monkeypatch.setattr(alarms, "_booked", booked)
    assert_near(np.full(20, 5.8), 0, 1)  # above 5.33, the limit of a single value
    for _ in range(4):
        assert_fits([50, 50], [50, 50], among=4)
    assert booked == [ALPHA, *[ALPHA / 4] * 4]
    with pytest.raises(AssertionError, match=r"5\.80 sigmas"):
        assert_near(5.8, 0, 1)
    random = np.random.default_rng(0)
    tilted = random.multinomial(100_000, np.where(np.arange(100) < 50, 0.01035, 0.00965))
    assert_fits(tilted, np.full(100, 1000), among=10**9)
    with pytest.raises(AssertionError, match="chi-square"):
        assert_fits(tilted, np.full(100, 1000))
