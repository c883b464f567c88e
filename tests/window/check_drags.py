"""The picture follows every drag that restarts it, however slow the machine is.

Each frame of these drags has time for a small part of a picture alone: one of all pixels takes
hundreds of frames, the coarsest one four.
"""

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from imgui_bundle import imgui

from glrt.rendering.renderer import Renderer
from glrt.settings import Cost
from glrt.view.panels.gizmo import is_held
from glrt.view.state import preview_noise
from glrt.view.state.frame_budget import FrameBudget
from glrt.view.state.preferences import Preferences
from glrt.view.state.preview_noise import FirstSurface
from tests.window.gestures import ball, place_of
from tests.window.hand import Hand, check

STEPS = 12  # of a drag: each takes the mouse a frame or two
SIDE = 128  # pixels of the picture: 256 tiles; a frame does one of them
LEAST = STEPS // 3  # pictures that differ from the one before
DRAWING, SETTLED = 0.05, 16  # seconds for a picture; frames after which the budget knows of it

Place = tuple[float, float]


class NoTime(FrameBudget):
    """Frames that have time for one dispatch, and that one for a tile."""

    @property
    def seconds(self) -> float:
        return 1e-9


@contextmanager
def slowly(hand: Hand, grain_read: float = math.inf) -> Iterator[None]:
    """Let frames have no time, once a picture is there by which the window knows its speed.

    Pictures of more grain than `grain_read` are not shown. Pictures of one sample come near the
    window's own limit: in some runs a drag would end with a change to first surfaces.
    """
    app = hand.window.app

    def begin() -> None:
        app.preferences = Preferences()
        hand.session.edit(width=SIDE, height=SIDE)

    hand.there(begin)
    hand.settle()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(preview_noise, "MOST", grain_read)
        patch.setattr(app, "pace", NoTime(10))
        yield


@check
def what_it_takes_to_draw_the_picture_is_no_time_for_samples(hand: Hand) -> None:
    """Pictures that take 50 ms more to draw leave 50 ms less, at 10 frames a second."""
    app = hand.window.app
    drawn = app.show.draw

    def slow(*given: Any) -> None:
        time.sleep(DRAWING)
        drawn(*given)

    hand.there(lambda: app.session.edit(samples=1 << 20))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(app, "pace", FrameBudget(10))
        patch.setattr(app.show, "draw", slow)
        hand.ctx.yield_(SETTLED)
        assert app.pace.seconds <= 0.1 - 0.9 * DRAWING


def followed(hand: Hand, places: list[Place]) -> int:
    """Drag the mouse from place to place; how many pictures were shown that are not the last."""
    hand.ctx.mouse_teleport_to_pos(places[0])
    hand.ctx.yield_(2)
    hand.ctx.mouse_down(0)
    pictures = [hand.pixels()]
    for place in places[1:]:
        hand.ctx.mouse_teleport_to_pos(place)
        pictures.append(hand.pixels())
    last, count = pictures[0], 0
    for picture in pictures[1:]:
        is_new = picture.shape != last.shape or (picture != last).any()
        count, last = count + is_new, picture
    assert hand.session.last_cost is Cost.RESTART
    hand.ctx.mouse_up(0)
    return count


def line(start: Place, across: float, down: float = 0.0) -> list[Place]:
    """Places of the mouse on a drag by so many pixels."""
    shares = np.linspace(0, 1, STEPS + 1)
    return [(start[0] + share * across, start[1] + share * down) for share in shares]


def is_whole_again(hand: Hand) -> bool:
    """Whether the picture of all pixels comes back, with the bits of a fresh render."""
    hand.settle()
    session = hand.session

    def is_fresh() -> bool:
        image = session.image()
        fresh = Renderer(session.scene, session.settings, session.context)
        expected = fresh.render(image.samples).image().radiance
        fresh.release()
        return bool((expected == image.radiance).all())

    return hand.there(is_fresh)


@check
def the_picture_follows_the_handles(hand: Hand) -> None:
    number, shape = ball(hand)
    with slowly(hand):
        hand.window.app.selected = number
        start = place_of(hand, shape.center)
        hand.ctx.mouse_move_to_pos(start)
        hand.ctx.yield_(4)
        assert hand.there(lambda: is_held(hand.window.app))
        assert followed(hand, line(start, 120)) >= LEAST
    assert is_whole_again(hand)
    assert hand.session.scene.objects[number] != shape
    hand.window.app.selected = None


@check
def the_picture_follows_sliders(hand: Hand) -> None:
    number, shape = ball(hand)
    for reference, across in (
        ("bounces", -60),
        ("fov", 60),
        (f"radius##shape {number}", 60),
        (f"color##material {shape.material}/##X", -120),
    ):
        hand.begin()
        hand.window.app.selected = number
        hand.ctx.yield_(3)
        before = hand.session.state
        with slowly(hand):
            hand.ctx.mouse_move(f"//Controls/{reference}")
            hand.ctx.yield_(2)
            x, y = imgui.get_io().mouse_pos
            assert followed(hand, line((x, y), across)) >= LEAST, reference
        assert is_whole_again(hand), reference
        assert hand.session.state.scene != before.scene or reference == "bounces"
    hand.window.app.selected = None


@check
def a_drag_too_noisy_to_read_shows_first_surfaces_and_says_so(hand: Hand) -> None:
    """The frames have no time for a second sample: all that there is of the light is noise."""
    number, shape = ball(hand)
    app = hand.window.app
    first = FirstSurface()
    with slowly(hand, grain_read=0.01):
        hand.session.surface = first
        app.selected = number
        start = place_of(hand, shape.center)
        hand.ctx.mouse_move_to_pos(start)
        hand.ctx.yield_(4)
        assert followed(hand, line(start, 120)) >= LEAST // 2
        assert app.show.is_surface
        assert "first surface" in app.show.notice(hand.session)
        hand.ctx.mouse_move("//Controls/bounces")
        x, y = imgui.get_io().mouse_pos
        assert followed(hand, line((x, y), -60)) >= LEAST
        assert not app.show.is_surface, "bounces are not seen on it"
    assert is_whole_again(hand)
    assert not app.show.is_surface
    hand.session.surface, app.selected = FirstSurface(), None
