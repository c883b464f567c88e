"""Verdicts that chance could turn: each fails a sound program once in 10 million seeds (ALPHA).

Seeds are fixed, so a verdict changes only when code or driver do. Every verdict is booked here;
a run of tests says at its end what chance it had of a false alarm, and fails above LIMIT.
"""

import math
from collections.abc import Iterator
from statistics import NormalDist

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from tests.support.workers import report, reported_by

ALPHA = 1e-7  # of one verdict
LIMIT = 1e-4  # of a run of all tests that are not slow, or of all slow ones
SIGMAS = NormalDist().inv_cdf(1 - ALPHA / 2)  # 5.33
CHANCE = "chance of a false alarm"  # of what one process booked
FEWEST = 20.0  # expected counts in a cell: fewer are not normal enough for small chances

Floats = NDArray[np.float64]

_booked: list[float] = []


def book(verdicts: float = 1) -> None:
    """So many verdicts are given, each with a chance of ALPHA to be wrong."""
    _booked.append(verdicts * ALPHA)


def assert_near(value: ArrayLike, truth: ArrayLike, deviation: ArrayLike) -> None:
    """Each value lies where a normal one of this mean and standard deviation would.

    All of them are one verdict: its chance is shared out evenly (Bonferroni).
    """
    scores = np.abs(np.asarray(value) - np.asarray(truth)) / np.asarray(deviation)
    book()
    limit = NormalDist().inv_cdf(1 - ALPHA / scores.size / 2)
    assert np.max(scores) <= limit, f"{np.max(scores):.2f} sigmas: {value!r} against {truth!r}"


def assert_fits(counts: ArrayLike, expected: ArrayLike, among: int = 1) -> None:
    """Counts of independent draws, whose number is fixed, are as expected: Pearson's chi-square.

    Cells are pooled until each expects FEWEST draws; in one that expects none there may be none.
    A test that judges several tables as one verdict says `among` how many.
    """
    found, wanted = np.ravel(counts).astype(np.float64), np.ravel(expected).astype(np.float64)
    assert found[wanted == 0].sum() == 0, "draws where the density is 0"
    found, wanted = pooled(found, wanted)
    statistic = float(((found - wanted) ** 2 / wanted).sum())
    degrees = len(wanted) - 1
    book(1 / among)
    p = chi_square_tail(statistic, degrees)
    assert p >= ALPHA / among, f"chi-square {statistic:.1f} of {degrees} degrees: p {p:.2g}"


def pooled(found: Floats, wanted: Floats) -> tuple[Floats, Floats]:
    """Cells joined, from the emptiest on, until each expects FEWEST draws."""
    order = np.argsort(wanted)
    starts, total = [0], 0.0
    for place, expected in enumerate(wanted[order]):
        if total >= FEWEST:
            starts.append(place)
            total = 0.0
        total += expected
    if total < FEWEST and len(starts) > 1:
        starts.pop()
    return np.add.reduceat(found[order], starts), np.add.reduceat(wanted[order], starts)


def chi_square_tail(statistic: float, degrees: int) -> float:
    """The chance that chi-square of so many degrees of freedom exceeds the statistic.

    Closed for even degrees: exp(-x/2) times the sum of (x/2)^k / k! below degrees / 2. An odd
    number uses the chance of one more: it is larger, so that it alarms no more often.
    """
    if statistic <= 0 or degrees < 1:
        return 1.0
    half = statistic / 2
    terms = [k * math.log(half) - math.lgamma(k + 1) - half for k in range((degrees + 1) // 2)]
    top = max(terms)
    return min(1.0, math.exp(top) * sum(math.exp(term - top) for term in terms))


@pytest.hookimpl(wrapper=True)
def pytest_sessionfinish(session: pytest.Session) -> Iterator[None]:
    """A run that would alarm too often by chance is no proof."""
    report(session.config, CHANCE, sum(_booked))
    yield
    if sum(_booked) > LIMIT and session.exitstatus == pytest.ExitCode.OK:
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: object) -> None:
    """A worker of pytest-xdist has ended: the limit is that of the whole run."""
    _booked.append(float(reported_by(node, CHANCE, 0.0)))


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    if chance := sum(_booked):
        text = f"chance of a false alarm with other seeds: {chance:.1e}"
        excess = f", which is above {LIMIT:g}" if chance > LIMIT else ""
        terminalreporter.write_line(text + excess)
