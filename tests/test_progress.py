"""The error over time: when it is looked at, and when it will be small enough."""

import pytest

from glrt.ui.progress import GROWTH, PAUSE, Look, Progress


def test_looks_come_with_growing_samples_and_pauses() -> None:
    progress = Progress()
    assert not progress.is_due(1, 1, 10.0)
    assert progress.is_due(1, 2, 10.0)
    progress.record(Look(100, 1.0, 0.5), 10.0)
    assert not progress.is_due(1, 1000, 10.0 + PAUSE / 2)
    assert not progress.is_due(1, int(100 * GROWTH) - 1, 10.0 + PAUSE)
    assert progress.is_due(1, int(100 * GROWTH), 10.0 + PAUSE)


def test_another_picture_forgets_the_one_before() -> None:
    progress = Progress()
    progress.record(Look(100, 1.0, 0.5), 0.0)
    assert progress.is_due(2, 2, 10.0)
    assert progress.error is None
    assert progress.remaining(0.1) is None


def test_the_forecast_is_that_of_noise() -> None:
    progress = Progress()
    progress.record(Look(64, 2.0, 0.2), 0.0)
    assert progress.remaining(0.1) == pytest.approx(6.0), "half the error takes four times as long"
    assert progress.remaining(0.3) == 0


def test_the_line_has_slope_minus_one_half_and_ends_at_the_last_look() -> None:
    progress = Progress()
    for look in (Look(4, 1.0, 0.9), Look(64, 16.0, 0.2)):
        progress.record(look, 0.0)
    seconds, errors = progress.slope()
    assert seconds == [1.0, 16.0]
    assert errors == pytest.approx([0.8, 0.2])
