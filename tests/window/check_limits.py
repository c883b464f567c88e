"""Extreme inputs of a user: the window goes on, and reports what is impossible."""

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from imgui_bundle import imgui
from imgui_bundle.imguizmo import im_guizmo

from glrt.scene.scene import Scene, with_lights
from glrt.scene.values import LARGEST, SMALLEST
from glrt.view.controls import replaced
from glrt.view.edits.scene_edits import with_object
from glrt.view.files import Files
from glrt.view.viewport import orbit
from tests.support.builders import lamp, plane, scene_of
from tests.window.gestures import ball, drag, reopen
from tests.window.hand import Hand, check

MOST_EVENTS = 1000  # of a wheel that spins freely
LONG = LARGEST / 100  # seconds of a walk


def goes_on(hand: Hand) -> None:
    """The window has frames, and the picture has samples."""
    hand.settle()
    samples = hand.session.samples
    hand.until(lambda: hand.session.samples > samples)


def moved_on(hand: Hand, move: Callable[[], None]) -> None:
    """Move the camera again and again, until it stops."""

    def again() -> None:
        for _ in range(MOST_EVENTS):
            before = hand.window.app.camera
            move()
            if hand.window.app.camera == before:
                return
        raise AssertionError("it does not stop")

    hand.there(again)
    goes_on(hand)


@check
def a_wheel_that_spins_freely_stops_at_the_limits(hand: Hand) -> None:
    app, start = hand.window.app, hand.session.scene.camera
    for mode, clicks in (("orbit", 1.0), ("orbit", -1.0), ("orbit", -45.0), ("fly", -9.0)):
        hand.there(partial(app.prefer, replaced(app.preferences, mode=mode)))
        moved_on(hand, partial(app.wheel, clicks))
        assert np.dot(orbit.axes(app.camera)[2], orbit.axes(start)[2]) > 1 - 1e-6
        hand.begin()
    hand.ctx.mouse_move("//Picture/picture")
    for clicks in (1e6, -1e6):
        hand.ctx.mouse_wheel_y(clicks)
        goes_on(hand)
    hand.ctx.key_press(imgui.Key.home.value)
    hand.settle()
    assert hand.session.scene.camera == start


@check
def a_walk_without_end_stops_at_the_limits(hand: Hand) -> None:
    app = hand.window.app
    for right, up, forward in ((0.0, 0.0, -1.0), (1.0, -1.0, 0.0)):
        moved_on(hand, partial(app.walk, right, up, forward, LONG))
        drag(hand, 60, 20)
        drag(hand, 20, -30, button=1)
        drag(hand, -20, -30, button=2)
        goes_on(hand)
        hand.there(app.home)


@check
def the_horizon_is_no_place_that_ends_the_window(hand: Hand) -> None:
    """A click near the horizon of a plane meets it beyond all lengths that a scene can have."""
    app = hand.window.app
    floor = plane([0, -1, 0], [1e-17, 1, 0], "lamp")
    hand.there(lambda: hand.session.edit(scene_of([floor], {"lamp": lamp()}, {"up": [1, 0, 0]})))
    hand.settle()
    for point in ((0.0, -1.0, -1e16), (1e300, -1.0, -1e300), (0.0, -1e-16, -1e-16)):
        hand.there(partial(app.focus_on, point))
        hand.there(partial(app.turn_about, point))
        assert SMALLEST <= app.camera.resolved_focus_distance <= LARGEST
        hand.there(lambda: app.wheel(1.0))
        drag(hand, 20, 10)
    assert "too far away" in hand.session.problem
    reopen(hand)


@check
def an_object_of_any_size_is_framed_or_reported(hand: Hand) -> None:
    app, (number, shape) = hand.window.app, ball(hand)
    for radius in (LARGEST, SMALLEST, 1e9):
        hand.there(partial(hand.session.edit, sized(hand, number, radius)))
        app.selected, before = number, app.camera
        hand.there(app.frame_selected)
        goes_on(hand)
        assert (app.camera.look_at == shape.center) == (radius == 1e9)
        assert bool(hand.session.problem) == (app.camera == before)
        hand.session.problem = ""
    hand.begin()
    app.selected = None


def sized(hand: Hand, number: int, radius: float) -> Scene:
    scene = hand.session.scene
    return with_object(scene, number, replaced(scene.objects[number], radius=radius))


@check
def whatever_is_typed_into_a_field_ends_nothing(hand: Hand) -> None:
    """Beyond floats and integers, and limits that are not valid themselves."""
    ctx, (number, shape) = hand.ctx, ball(hand)
    hand.window.app.selected = number
    ctx.set_ref("Controls")
    ctx.item_open("Preferences")
    for label, *texts in (
        ("seed", "9" * 5000, "-1", "1/0"),
        ("samples", "9" * 50),
        ("fov", "0", "1e39", "nan"),
        ("intensity##lamp", "1e39", "0"),
        ("emission##lamp/##emission/$$0", "1e39", "0"),
        ("position/$$2", "1e39", "-1e39", "0"),
        (f"radius##shape {number}", "0", "1e39"),
        (f"color##material {shape.material}/##X", "1e39"),
        ("walk speed##preference", "0"),
        ("target error##preference", "0", "1e39"),
        ("scale##preference", "1e39", "-1", "1"),
    ):
        for text in texts:
            ctx.item_input_value(label, text)
            ctx.yield_(4)  # a problem moves the rows
    ctx.item_close("Preferences")
    hand.begin()
    goes_on(hand)
    hand.window.app.selected = None


@check
def a_black_picture_has_figures(hand: Hand) -> None:
    """Its error is 0, for which logarithmic axes have no place."""
    for intensity in (0.0, LARGEST / 100):
        relit = with_lights(hand.session.scene, {"lamp": intensity})
        hand.there(partial(hand.session.edit, relit))
        hand.until(lambda: len(hand.window.app.progress.looks) > 1)
        goes_on(hand)


@check
def handles_that_scale_an_object_to_nothing_report_it(hand: Hand) -> None:
    number, shape = ball(hand)
    hand.window.app.selected = number
    handles: Any = im_guizmo
    manipulate = handles.manipulate

    def shrink(view: Any, projection: Any, operation: Any, mode: Any, matrix: Any) -> bool:
        matrix.values[:12] = 0.0
        return True

    try:
        handles.manipulate = shrink
        hand.until(lambda: "radius" in hand.session.problem)
    finally:
        handles.manipulate = manipulate
    goes_on(hand)
    assert hand.session.scene.objects[number] == shape
    hand.window.app.selected = None


def saved(files: Files, path: str) -> None:
    """Save the picture, and wait for the end."""
    files.save_picture(path)
    files.finish_picture()


@check
def what_is_no_scene_and_what_is_no_file_is_reported(hand: Hand) -> None:
    app, before = hand.window.app, hand.session.state
    noise = Path.cwd() / "noise.png"
    noise.write_bytes(bytes(range(256)) * 9)
    for source in (".", "/", str(noise), "/dev/null", "x" * 5000, "x\0y", "~", "..", " "):
        told(hand, partial(app.files.open, source))
    for path in (".", "/", "x" * 5000 + ".png", "picture", "/dev/full", "x.png/y.png", " "):
        told(hand, partial(saved, app.files, path))
    for path in (".", "/", "x" * 5000 + ".toml", "noise.png/y.toml"):
        told(hand, partial(app.files.save_scene, path))
    for text in (
        "",
        "{",
        "null",
        "[]",
        '{"scene": {}}',
        '{"scene": {"title": "\\ud800"}}',
        "9" * 5000,
    ):
        hand.there(partial(imgui.set_clipboard_text, text))
        told(hand, app.files.paste_recipe)
    assert hand.session.state == before
    reopen(hand)


@check
def a_name_that_is_no_text_is_shown_and_kept(hand: Hand) -> None:
    """Linux has names of files that are not UTF-8."""
    app, file = hand.window.app, Path.cwd() / os.fsdecode(b"caf\xe9.toml")
    file.write_text((Path.cwd() / "scenes" / "cornell.toml").read_text())
    hand.ctx.item_open("//Controls/Files")
    hand.there(partial(app.files.open, str(file)))
    goes_on(hand)
    assert app.files.scene_path == str(file)
    hand.there(partial(saved, app.files, str(file.with_suffix(".png"))))
    hand.there(app.files.save_scene)
    goes_on(hand)
    assert not hand.session.problem
    hand.ctx.item_close("//Controls/Files")
    reopen(hand)


def told(hand: Hand, act: Callable[[], object]) -> None:
    """A command that is refused in a line, and changes nothing."""
    hand.session.problem = ""
    hand.there(act)
    assert hand.session.problem, act


@check
def undo_and_redo_end_where_there_is_nothing_more(hand: Hand) -> None:
    for _ in range(3):
        hand.there(lambda: hand.session.edit(seed=hand.session.settings.seed + 1))
    last = hand.session.state
    for step in (hand.session.undo, hand.session.redo):
        hand.there(partial(repeated, step))
        goes_on(hand)
    assert not hand.session.history.can_redo
    assert hand.session.history.can_undo
    hand.there(lambda: hand.session.edit(last.scene, **dict(last.settings)))


def repeated(act: Callable[[], None]) -> None:
    """More often than there are steps to undo."""
    for _ in range(600):
        act()
