"""The histogram of a picture, against pictures whose luminance is known."""

import numpy as np
import pytest

from glrt.view.state.histogram import STEPS, STOPS, histogram


def grey(*values: float) -> np.ndarray:
    return np.repeat(np.array(values, np.float32), 3).reshape(1, -1, 3)


def test_each_pixel_is_counted_where_its_luminance_is() -> None:
    found = histogram(grey(0.3, 0.3, 3.0, 0.0))
    assert found.shares.sum() == pytest.approx(0.75)
    assert found.black == 0.25
    for value, share in ((0.3, 0.5), (3.0, 0.25)):
        place = np.abs(found.stops - np.log2(value)).argmin()
        assert found.shares[place] == share


def test_colours_weigh_as_they_are_seen() -> None:
    green = histogram(np.array([[[0.0, 1.0, 0.0]]]))
    assert found_stop(green) == pytest.approx(np.log2(0.7152), abs=step())
    white = histogram(np.array([[[0.9, 0.9, 0.9]]]))
    assert found_stop(white) == pytest.approx(np.log2(0.9), abs=step())


def found_stop(found: object) -> float:
    return float(found.stops[found.shares.argmax()])  # type: ignore[attr-defined]


def step() -> float:
    return (STOPS[1] - STOPS[0]) / STEPS


def test_what_is_beyond_the_ends_is_in_the_outermost_steps() -> None:
    found = histogram(grey(1e-30, 1e30))
    assert (found.shares[0], found.shares[-1]) == (0.5, 0.5)
    assert histogram(-grey(1.0)).black == 1


def test_the_share_above_white_follows_the_exposure() -> None:
    found = histogram(grey(0.4, 0.9, 1.9, 3.9))
    assert [found.above(exposure) for exposure in (-2.0, -1.0, 0.0, 2.0)] == [0, 0.25, 0.5, 1]
