"""The noise of a coarse picture decides whether the first surface is shown in its place."""

import numpy as np
import pytest

from glrt.view.state.preview_noise import MOST, SURE, FirstSurface, grain_of


def noisy(deviation: float, size: tuple[int, int] = (60, 80)) -> np.ndarray:
    """A picture of shades and an edge, with noise: deviation with black to white as 1."""
    rng = np.random.default_rng(3)
    down, across = np.mgrid[: size[0], : size[1]] / 100
    light = 0.3 + 0.2 * down + 0.3 * (across > 0.4) + rng.normal(0, deviation, size)
    codes = np.clip(np.round(255 * light), 0, 255).astype(np.uint8)
    return np.repeat(codes[..., None], 4, axis=2)


@pytest.mark.parametrize("deviation", [0.03, 0.06, 0.12])
def test_grain_is_the_deviation_of_the_noise(deviation: float) -> None:
    assert grain_of(noisy(deviation)) == pytest.approx(deviation, rel=0.15)


def test_shades_and_edges_are_hardly_grain() -> None:
    assert grain_of(noisy(0.0)) < 0.01


@pytest.mark.parametrize("size", [(1, 1), (2, 9), (9, 2)])
def test_a_picture_that_is_too_small_has_none(size: tuple[int, int]) -> None:
    assert grain_of(noisy(0.2, size)) == 0.0


def after(*deviations: float) -> FirstSurface:
    """Pictures of a drag of an object."""
    surface = FirstSurface()
    surface.is_apt = True
    for deviation in deviations:
        surface.judge(noisy(deviation))
    return surface


def test_a_picture_that_cannot_be_read_calls_for_the_first_surface_to_the_end_of_the_drag() -> None:
    assert not after(0.5 * MOST).is_wanted
    assert after(0.5 * MOST, 1.5 * MOST).is_wanted
    assert after(1.5 * MOST, 0.5 * MOST).is_wanted


def test_the_next_drag_begins_as_the_last_one_would_have() -> None:
    surface = after(1.5 * MOST, 0.5 * MOST)
    surface.end()
    assert surface.is_wanted
    surface.judge(noisy(0.5 * SURE * MOST))
    surface.end()
    assert not surface.is_wanted


def test_a_drag_that_is_not_seen_on_surfaces_shows_the_light() -> None:
    surface = after(1.5 * MOST)
    surface.is_apt = False
    assert not surface.is_wanted


def test_what_the_driver_refuses_is_not_tried_again() -> None:
    surface = after(1.5 * MOST)
    assert surface.refuse()
    assert not surface.refuse()
    surface.judge(noisy(1.5 * MOST))
    assert not surface.is_wanted
