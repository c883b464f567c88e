"""Preferences: chosen in the panel, obeyed, and kept in a file."""

import json
import math
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from imgui_bundle import imgui

from glrt.view.controls import replaced
from glrt.view.panels.plots import figures
from glrt.view.viewport import orbit
from tests.window.gestures import drag, far_apart, move
from tests.window.hand import Hand, check

# Each preference by its label: what to choose.
CHOICES: dict[str, Any] = {
    "temporal": "reproject",
    "predictor": "delayed",
    "samples per frame": 3,
    "target error": 0.1,
    "mode": "fly",
    "frame rate": 20,
    "turn speed": 90.0,
    "walk speed": 2.0,
    "wheel speed": 3.0,
    "invert": True,
    "axes": True,
    "theme": "light",
    "scale": 1.25,
    "tour": True,
}


@check
def preferences_are_chosen_and_restart_nothing(hand: Hand) -> None:
    app, ctx, session = hand.window.app, hand.ctx, hand.session
    ctx.set_ref("Controls")
    ctx.item_open("Preferences")
    for label, value in CHOICES.items():
        restarts, samples = session.restarts, session.samples
        reference = f"{label}##preference"
        is_choice = isinstance(value, str)
        move(hand, f"{reference}/{value}" if is_choice else reference, tuned(value))
        ctx.yield_(2)
        assert getattr(app.preferences, label.replace(" ", "_")) == value, label
        assert (session.restarts, session.problem) == (restarts, "")
        assert session.samples >= samples
    assert app.pace.frames_per_second == 20
    assert imgui.get_style().font_scale_main == 1.25
    assert hand.there(lambda: imgui.get_style().color_(imgui.Col_.window_bg).x) > 0.8
    assert "10 %" in "\n".join(figures(app))
    move(hand, "scale##preference", 1.0)
    ctx.item_close("Preferences")
    start, (width, height) = session.scene.camera, imgui.get_io().display_size
    drag(hand, 90, 40)
    expected = orbit.looked(start, -90 * 90 / width, 90 * 40 / height)
    assert far_apart(session.scene.camera, expected) < 0.02, "slower, upside down, where it stands"
    before, step = session.scene.camera, 0.1 * 3.0 * app.reach
    ctx.mouse_wheel_y(1)
    hand.settle()
    walked = math.dist(session.scene.camera.position, before.position)
    assert walked == pytest.approx(step, rel=1e-5), "three times as far"


def tuned(value: Any) -> Any:
    """The value that `move` types for it; None clicks or chooses."""
    return None if isinstance(value, bool | str) else value


@check
def preferences_are_kept_while_the_window_is_open(hand: Hand) -> None:
    file = hand.window.app.preferences_file
    file.unlink(missing_ok=True)
    hand.ctx.set_ref("Controls")
    hand.ctx.combo_click("mode##preference/fly")
    hand.until(lambda: kept(file).get("mode") == "fly")
    before = hand.session.scene.camera
    drag(hand, 60, 0)
    assert hand.session.scene.camera.position == before.position, "fly: it turns where it stands"


def kept(file: Path) -> dict[str, Any]:
    """The values in a file of preferences; empty if there is none."""
    return dict(json.loads(file.read_text())) if file.exists() else {}


@check
def the_frame_rate_is_what_is_preferred(hand: Hand) -> None:
    app = hand.window.app
    for wanted, expected in ((20, 20), (0, 10 if hand.session.context.is_software else 30)):
        hand.there(partial(app.prefer, replaced(app.preferences, frame_rate=wanted)))
        hand.ctx.yield_(2)
        assert app.pace.frames_per_second == expected


@check
def the_scale_enlarges_margins_as_it_does_type(hand: Hand) -> None:
    """And back at 1 all sizes are those of the start."""
    app = hand.window.app

    def sizes() -> tuple[float, ...]:
        style = imgui.get_style()
        return style.frame_padding.x, style.item_spacing.y, style.scrollbar_size

    start = hand.there(sizes)
    for scale in (2.0, 1.3, 2.0):
        app.prefer(replaced(app.preferences, scale=scale))
        hand.ctx.yield_(3)
    assert hand.there(sizes) == tuple(2 * size for size in start)
    app.prefer(replaced(app.preferences, scale=1.0))
    hand.ctx.yield_(3)
    assert hand.there(sizes) == start
