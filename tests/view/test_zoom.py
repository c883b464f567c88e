"""The zoom of the picture, by arithmetic alone."""

import pytest

from glrt.view.state.zoom import FIT, LEAST, MOST, Zoom, common

ROOM, SIZE = (800.0, 600.0), (400, 200)


def test_a_picture_that_fits_is_as_large_as_the_room_and_in_its_middle() -> None:
    assert FIT.placed(ROOM, SIZE) == (0, 100, 800, 400)
    assert FIT.placed((300.0, 600.0), SIZE) == (0, 225, 300, 150)
    assert FIT.placed((0.0, 0.0), SIZE)[2:] == (1, 1)


def test_at_one_to_one_a_pixel_is_a_pixel() -> None:
    assert Zoom(1.0).placed(ROOM, SIZE) == (200, 200, 400, 200)
    assert Zoom(4.0, (0.0, 0.0)).placed(ROOM, SIZE) == (400, 300, 1600, 800)


@pytest.mark.parametrize("start", [FIT, Zoom(1.0), Zoom(3.0, (0.25, 0.75))])
@pytest.mark.parametrize("factor", [2.0, 0.5, 1.3])
def test_what_is_under_the_mouse_stays_there(start: Zoom, factor: float) -> None:
    at = (500.0, 250.0)
    after = start.about(ROOM, SIZE, at, factor)
    assert after.scale == pytest.approx(factor * start.scale_in(ROOM, SIZE))
    left, top, width, height = start.placed(ROOM, SIZE)
    share = (at[0] - left) / width, (at[1] - top) / height
    left, top, width, height = after.placed(ROOM, SIZE)
    there = left + share[0] * width, top + share[1] * height
    assert there == pytest.approx(at, abs=2)  # corners of pixels lie on those of the screen


def test_the_scale_has_ends() -> None:
    for factor, end in ((1e6, MOST), (1e-6, LEAST)):
        assert Zoom(1.0).about(ROOM, SIZE, (400.0, 300.0), factor).scale == end


def test_a_drag_moves_the_picture_with_the_mouse_and_never_out_of_sight() -> None:
    zoom = Zoom(4.0)
    before, after = zoom.placed(ROOM, SIZE), zoom.shifted(SIZE, 30, -20).placed(ROOM, SIZE)
    assert (after[0] - before[0], after[1] - before[1]) == pytest.approx((30, -20))
    far = zoom.shifted(SIZE, 1e6, 1e6)
    assert far.center == (0, 0)
    assert FIT.shifted(SIZE, 30, 20) == FIT


def test_rectangles_overlap_or_not() -> None:
    assert common((0, 0, 10, 10), (5, -5, 10, 10)) == (5, 0, 5, 5)
    assert common((0, 0, 1, 1), (5, 5, 1, 1))[2:] == (0, 0)
