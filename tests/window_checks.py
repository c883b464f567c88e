"""What a user does in the window, and what must come of it; tests/test_window.py runs this."""

import json
import math
import os
import re
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from imgui_bundle import imgui

from glrt.false_colors import ERROR
from glrt.image import read_recipe
from glrt.library import load
from glrt.renderer import Renderer
from glrt.resources import folder
from glrt.scene import Camera, Scene
from glrt.scene_file import read_scene
from glrt.settings import Cost
from glrt.ui import dialogs, orbit, panel, widgets
from glrt.ui.controls import Control, replaced
from glrt.ui.gizmo import is_held
from glrt.ui.orbit import axes
from glrt.ui.picture import Picture
from glrt.ui.plots import figures
from glrt.ui.preferences import Preferences
from tests.hand import SMALL, Hand, check

# Each control by its label in the panel: the control, and what to do to it.
MOVES: dict[str, tuple[Control, Any]] = {
    "intensity##lamp": (panel.INTENSITY, 3.0),
    "emission##lamp/##emission/$$0": (panel.EMISSION.costing(Cost.RELIGHT), 2.0),
    "bounces": (panel.SETTINGS["bounces"], 1),
    "method/nee": (panel.SETTINGS["method"], None),
    "sampler/independent": (panel.SETTINGS["sampler"], None),
    "seed": (panel.SETTINGS["seed"], 7),
    "roulette": (panel.SETTINGS["roulette"], None),
    "samples": (panel.SETTINGS["samples"], 5000),
    "exposure": (panel.SETTINGS["exposure"], 2.0),
    "tonemap/agx": (panel.SETTINGS["tonemap"], None),
    "fov": (panel.CAMERA["fov"], 20.0),
    "focus distance": (panel.CAMERA["focus_distance"], 2.0),
    "defocus angle": (panel.CAMERA["defocus_angle"], 3.0),
    "position/$$2": (panel.CAMERA["position"], 3.0),
    "look at/$$0": (panel.CAMERA["look_at"], 0.3),
    "color##background/##color/$$2": (panel.BACKGROUND["color"], 0.5),
    "width": (panel.SETTINGS["width"], 30),
    "height": (panel.SETTINGS["height"], 30),
}
UNSEEN = (
    "samples",
    "focus distance",
)  # the first shows no other picture, the second not without a lens


def move(hand: Hand, reference: str, value: Any) -> None:
    """Do what a user does to a control."""
    hand.ctx.set_ref("Controls")
    if value is None and "/" in reference:
        hand.ctx.combo_click(reference)
    elif value is None:
        hand.ctx.item_click(reference)
    else:
        hand.ctx.item_input_value(reference, value)


@check
def every_control_costs_what_it_says(hand: Hand) -> None:
    order = list(Cost)
    hand.ctx.set_ref("Controls")
    for header in ("Background", "Frame"):
        hand.ctx.item_open(header)
    for reference, (control, value) in MOVES.items():
        hand.begin()
        session = hand.session
        before, samples = hand.pixels(), session.samples
        restarts, session.last_cost = session.restarts, None
        move(hand, reference, value)
        hand.settle()
        cost = session.last_cost or Cost.FREE
        assert order.index(cost) <= order.index(control.cost), (reference, cost)
        restarted = session.restarts - restarts
        assert restarted == (control.cost in (Cost.RESTART, Cost.RECOMPILE)), reference
        assert restarted or session.samples >= samples, reference
        assert not session.problem, (reference, session.problem)
        after = hand.pixels()
        if reference not in UNSEEN:
            changed = after.shape != before.shape or (after != before).mean() > 0.05
            assert changed, reference
    for header in ("Background", "Frame"):
        hand.ctx.item_close(header)


# Each preference by its label: what to choose.
CHOICES: dict[str, Any] = {
    "samples per frame": 3,
    "target error": 0.1,
    "mode": "fly",
    "frame rate": 20,
    "turn speed": 90.0,
    "walk speed": 2.0,
    "wheel speed": 3.0,
    "invert": True,
    "theme": "light",
    "scale": 1.25,
}
SECTIONS = ("Background", "Frame", "Files", "Mouse and keys", "Window")  # closed at the start


@check
def preferences_are_chosen_and_restart_nothing(hand: Hand) -> None:
    app, ctx, session = hand.window.app, hand.ctx, hand.session
    ctx.set_ref("Controls")
    ctx.item_open("Window")
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
    ctx.item_close("Window")
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
    """What `move` types for it; None clicks or chooses."""
    return None if isinstance(value, bool | str) else value


@check
def every_control_of_the_panel_is_moved_here(hand: Hand) -> None:
    """So that one that is added is added to the checks, too."""
    drawn: set[str] = set()
    inner = widgets.edited

    def seen(control: Control, value: Any, name: str = "") -> Any:
        drawn.add(f"{control.label}##{name}" if name else control.label)
        return inner(control, value, name)

    hand.ctx.set_ref("Controls")
    widgets.edited = panel.edited = seen  # type: ignore[attr-defined]
    for section in SECTIONS:
        hand.ctx.item_open(section)
    hand.ctx.yield_(2)
    widgets.edited = panel.edited = inner  # type: ignore[attr-defined]
    for section in SECTIONS:
        hand.ctx.item_close(section)
    moved = {reference.partition("/")[0] for reference in MOVES}
    moved |= {f"{label}##preference" for label in CHOICES}
    assert drawn == moved


@check
def a_hue_is_picked_without_a_change_of_brightness(hand: Hand) -> None:
    ctx, before = hand.ctx, lamp_of(hand)
    ctx.set_ref("Controls")
    ctx.item_click("emission##lamp/hue")
    ctx.yield_(2)
    ctx.set_ref("//$FOCUSED")
    ctx.item_input_value("##picker/##rgb/##Y", 0.25)
    hand.settle()
    after = lamp_of(hand)
    assert max(after) == pytest.approx(max(before), rel=1e-5)
    assert after[1] == pytest.approx(0.25 * max(before), rel=1e-3)
    assert after[2] == pytest.approx(before[2], rel=1e-3)
    ctx.popup_close_all()
    ctx.yield_(2)


def lamp_of(hand: Hand) -> Any:
    return hand.session.scene.materials["lamp"].emission  # type: ignore[union-attr]


@check
def buttons_and_boxes_of_the_scene_restart_it(hand: Hand) -> None:
    ctx, session, start = hand.ctx, hand.session, hand.session.scene
    ctx.set_ref("Controls")
    ctx.item_input_value("focus distance", 2.0)
    hand.settle()
    ctx.item_click("focus on look at")
    hand.settle()
    assert session.scene.camera.focus_distance is None
    ctx.item_open("Background")
    restarts = session.restarts
    ctx.item_click("gradient")
    hand.settle()
    assert session.scene.background.top is not None
    move(hand, "top##background/##top/$$2", 0.5)
    hand.settle()
    assert session.scene.background.top == (0.0, 0.0, 0.5)
    assert session.restarts > restarts
    move(hand, "bottom##background/##bottom/$$0", 0.25)
    ctx.item_click("gradient")
    hand.settle()
    assert session.scene.background.color == (0.0, 0.0, 0.5)
    ctx.item_close("Background")
    hand.there(lambda: hand.window.app.turn(0.1, 0.1, about_camera=False))
    ctx.item_click("home")
    hand.settle()
    assert session.scene.camera == start.camera


def drag(hand: Hand, across: float, down: float, button: int = 0) -> None:
    """From the middle of the picture, by pixels; in several steps, as a mouse moves."""
    ctx = hand.ctx
    ctx.mouse_move("//Picture/picture")
    ctx.mouse_down(button)
    x, y = imgui.get_io().mouse_pos
    for share in (0.25, 0.5, 0.75, 1.0):
        ctx.mouse_move_to_pos((x + share * across, y + share * down))
    ctx.mouse_up(button)
    hand.settle()


def far_apart(a: Camera, b: Camera) -> float:
    return max(math.dist(a.position, b.position), math.dist(a.look_at, b.look_at))


@check
def a_drag_turns_by_its_share_of_the_window(hand: Hand) -> None:
    before, (width, height) = hand.session.scene.camera, imgui.get_io().display_size
    drag(hand, 90, 40)
    yaw, pitch = -180 * 90 / width, -180 * 40 / height
    expected = orbit.orbited(before, before.look_at, yaw, pitch)
    assert far_apart(hand.session.scene.camera, expected) < 0.02
    assert math.dist(hand.session.scene.camera.look_at, before.look_at) < 1e-6


@check
def the_right_button_looks_around_and_the_middle_one_shifts(hand: Hand) -> None:
    before = hand.session.scene.camera
    drag(hand, 60, 0, button=1)
    looked = hand.session.scene.camera
    assert looked.position == before.position
    assert looked.look_at != before.look_at
    drag(hand, 60, 0, button=2)
    shifted = hand.session.scene.camera
    assert np.allclose(np.subtract(shifted.view, looked.view), 0, atol=1e-6)
    assert shifted.position != looked.position


@check
def a_drag_is_one_step_to_undo(hand: Hand) -> None:
    before = hand.session.scene.camera
    drag(hand, 50, 30)
    after = hand.session.scene.camera
    hand.ctx.item_click("//Controls/undo")
    hand.settle()
    assert hand.session.scene.camera == before
    hand.ctx.item_click("//Controls/redo")
    hand.settle()
    assert hand.session.scene.camera == after


@check
def wheel_and_keys_move_the_camera(hand: Hand) -> None:
    start = hand.session.scene.camera
    hand.ctx.mouse_move("//Picture/picture")
    hand.ctx.mouse_wheel_y(2)
    hand.settle()
    nearer = hand.session.scene.camera
    assert far_apart(nearer, orbit.dollied(start, start.look_at, 2)) < 1e-6
    for key, axis, sign in (
        *((imgui.Key.w, 2, 1), (imgui.Key.down_arrow, 2, -1), (imgui.Key.a, 0, -1)),
        *((imgui.Key.right_arrow, 0, 1), (imgui.Key.e, 1, 1), (imgui.Key.q, 1, -1)),
    ):
        before = hand.session.scene.camera
        hand.ctx.key_down(key.value)
        hand.ctx.yield_(3)
        hand.ctx.key_up(key.value)
        hand.settle()
        step = np.subtract(hand.session.scene.camera.position, before.position)
        along = np.array(orbit.axes(before)) @ step
        assert sign * along[axis] > 0.99 * np.linalg.norm(step) > 0, key
    hand.ctx.key_press(imgui.Key.home.value)
    hand.settle()
    assert hand.session.scene.camera == start


@check
def keys_that_are_typed_into_a_box_move_nothing(hand: Hand) -> None:
    before = hand.session.scene.camera
    hand.ctx.item_open("//Controls/Files")
    hand.ctx.item_click("//Controls/##open")
    hand.ctx.key_chars_append("weasd")
    assert hand.session.scene.camera == before
    assert hand.window.app.open_path == "weasd"
    hand.ctx.key_press(imgui.Key.enter.value)
    hand.ctx.item_click("//Controls/open")
    hand.settle()
    assert "weasd" in hand.session.problem
    hand.ctx.item_click("//Controls/dismiss")
    assert hand.session.problem == ""


def press(hand: Hand, key: imgui.Key, modifiers: int = 0) -> None:
    hand.ctx.key_press(key.value | modifiers)
    hand.ctx.yield_(3)


@check
def keys_are_chosen_in_the_panel(hand: Hand) -> None:
    app, ctx, start = hand.window.app, hand.ctx, hand.session.scene.camera
    ctx.set_ref("Controls")
    ctx.item_open("Mouse and keys")
    ctx.item_click("keys/Home##home 0")
    press(hand, imgui.Key.h)
    assert list(app.preferences.bindings["home"]) == ["h"]
    ctx.item_click("keys/+##home 1")
    press(hand, imgui.Key.f5, imgui.Key.mod_ctrl.value)
    assert list(app.preferences.bindings["home"]) == ["h", "ctrl+f5"]
    assert hand.session.scene.camera == start
    drag(hand, 60, 20)
    press(hand, imgui.Key.h)
    assert hand.session.scene.camera == start
    hand.until(app.preferences_file.exists, frames=1000)
    hand.until(lambda: "ctrl+f5" in app.preferences_file.read_text(), frames=1000)
    ctx.item_click("keys/W##forward 0")
    press(hand, imgui.Key.h)
    assert "H already means" in hand.session.problem
    assert app.preferences.bindings["forward"] == ("w", "up_arrow")
    assert hand.session.scene.camera == start
    ctx.item_click("keys/F##frame 0")
    press(hand, imgui.Key.escape)
    ctx.item_click("keys/F##frame 0")
    ctx.item_click("keys/remove##awaited")
    assert app.preferences.bindings["frame"] == ()
    ctx.item_click("reset keys")
    ctx.yield_(2)
    assert app.preferences.bindings == Preferences().bindings
    ctx.item_close("Mouse and keys")


@check
def the_picture_never_goes_black(hand: Hand) -> None:
    usual = hand.pixels()[..., :3].mean()
    edits: list[dict[str, Any]] = [{"method": "nee"}, {"width": 64}, {"bounces": 5}, {"seed": 3}]
    for edit in edits:
        hand.there(partial(hand.session.edit, **edit))
        for _ in range(6):
            assert hand.pixels()[..., :3].mean() > 0.25 * usual, edit


@check
def a_compilation_is_announced_while_the_old_picture_stays(hand: Hand) -> None:
    hand.session.paused = True
    hand.ctx.yield_()
    before = hand.pixels()
    hand.there(lambda: hand.session.edit(method="naive"))
    hand.until(lambda: bool(hand.session.busy), frames=3)
    assert (hand.pixels() == before).all()
    hand.until(lambda: not hand.session.busy)
    assert hand.session.last_cost is Cost.RECOMPILE


@check
def pause_keeps_the_samples_and_restart_drops_them(hand: Hand) -> None:
    hand.ctx.item_click("//Controls/pause")
    samples = hand.session.samples
    hand.ctx.yield_(5)
    assert hand.session.samples == samples > 0
    hand.ctx.item_click("//Controls/restart")
    hand.ctx.yield_(3)
    assert hand.session.samples == 1, "a paused picture shows its first sample"
    hand.ctx.item_click("//Controls/go on")
    hand.ctx.yield_(3)
    assert hand.session.samples > 1


@check
def samples_end_at_the_target(hand: Hand) -> None:
    hand.there(lambda: hand.session.edit(samples=7, seed=1))
    hand.until(lambda: hand.session.is_done)
    hand.ctx.yield_(3)
    assert hand.session.samples == 7
    hand.there(lambda: hand.session.edit(samples=9))
    hand.until(lambda: hand.session.samples == 9)


@check
def a_picture_is_saved_with_its_recipe_and_opened_again(hand: Hand) -> None:
    app = hand.window.app
    for suffix in ("png", "exr"):
        file = Path.cwd() / f"saved.{suffix}"
        hand.begin()
        hand.there(lambda: hand.session.edit(replaced_fov(hand, 25.0), samples=3))
        hand.until(lambda: hand.session.is_done)
        hand.there(partial(setattr, app, "save_path", str(file)))
        hand.there(app.save)
        hand.begin()
        hand.there(partial(app.open, str(file)))
        hand.settle()
        assert (hand.session.scene.camera.fov, hand.session.settings.samples) == (25.0, 3)
        reopen(hand)


def replaced_fov(hand: Hand, fov: float) -> Scene:
    scene = hand.session.scene
    return replaced(scene, camera=replaced(scene.camera, fov=fov))


@check
def a_recipe_is_copied_and_pasted(hand: Hand) -> None:
    hand.ctx.item_open("//Controls/Files")
    hand.there(lambda: hand.session.edit(replaced_fov(hand, 31.0), bounces=2, exposure=1.5))
    hand.settle()
    hand.ctx.item_click("//Controls/copy recipe")
    hand.begin()
    hand.ctx.item_click("//Controls/paste recipe")
    hand.settle()
    settings = hand.session.settings
    assert (hand.session.scene.camera.fov, settings.bounces, settings.exposure) == (31.0, 2, 1.5)
    hand.there(lambda: imgui.set_clipboard_text("no recipe"))
    hand.ctx.item_click("//Controls/paste recipe")
    assert hand.session.problem.startswith("The clipboard")
    reopen(hand)


def reopen(hand: Hand) -> None:
    """The scene that the window was opened with, small again."""
    hand.there(partial(hand.window.app.open, "cornell"))
    hand.there(lambda: hand.session.edit(**SMALL))
    hand.session.opened = hand.session.state


@check
def dialogs_of_the_desktop_open_and_save(hand: Hand) -> None:
    """A program that stands in for zenity: it answers what a file says."""
    app, folder, path = hand.window.app, Path.cwd() / "dialogs", os.environ["PATH"]
    folder.mkdir()
    answer, program = folder / "answer", folder / "zenity"
    program.write_text(f"#!/bin/sh\nuntil [ -s {answer} ]; do sleep 0.02; done\ncat {answer}\n")
    program.chmod(0o755)
    os.environ["PATH"] = f"{folder}:{path}"
    hand.ctx.item_open("//Controls/Files")
    hand.ctx.set_ref("Controls")

    def choose(button: str, file: Path) -> None:
        answer.unlink(missing_ok=True)
        hand.ctx.item_click(button)
        samples = hand.session.samples
        hand.until(lambda: hand.session.samples > samples)
        assert app.dialogs.is_open
        (folder / "new").write_text(f"{file}\n")
        (folder / "new").rename(answer)
        hand.until(lambda: not app.dialogs.is_open, frames=1000)

    try:
        choose("...##scene file", folder / "cornell.toml")
        assert read_scene(folder / "cornell.toml") == hand.session.scene.model_copy(
            update={"render": hand.session.scene.render.model_copy(update=SMALL)}
        )
        choose("...##save", folder / "shot.exr")
        assert read_recipe(folder / "shot.exr").scene == hand.session.scene
        choose("...##open", folder / "shot.exr")
        assert app.source == str(folder / "shot.exr")
        hand.ctx.item_click("...##open")
        hand.there(app.dialogs.close)
        assert not app.dialogs.is_open
    finally:
        os.environ["PATH"] = path
        hand.there(app.dialogs.close)
    reopen(hand)


@check
def without_dialogs_the_boxes_serve(hand: Hand) -> None:
    app, ctx, before = hand.window.app, hand.ctx, dialogs.PROGRAMS
    dialogs.PROGRAMS = ()  # type: ignore[assignment]
    ctx.item_open("//Controls/Files")
    ctx.yield_(2)
    assert not ctx.item_exists("//Controls/...##open")
    ctx.item_click("//Controls/##scene file")
    ctx.key_chars_replace_enter(str(Path.cwd() / "typed.toml"))
    ctx.yield_(2)
    assert read_scene(Path.cwd() / "typed.toml") == load("cornell").model_copy(
        update={"render": load("cornell").render.model_copy(update=SMALL)}
    )
    dialogs.PROGRAMS = before
    assert app.message.startswith("Saved")
    reopen(hand)


@check
def what_cannot_be_saved_is_told(hand: Hand) -> None:
    hand.there(partial(setattr, hand.window.app, "save_path", "/nowhere/picture.png"))
    hand.there(hand.window.app.save)
    assert "/nowhere" in hand.session.problem


@check
def preferences_are_kept_while_the_window_is_open(hand: Hand) -> None:
    file = hand.window.app.preferences_file
    file.unlink(missing_ok=True)
    hand.ctx.set_ref("Controls")
    hand.ctx.combo_click("mode##preference/fly")
    hand.until(lambda: kept(file).get("mode") == "fly", frames=1000)
    before = hand.session.scene.camera
    drag(hand, 60, 0)
    assert hand.session.scene.camera.position == before.position, "fly: it turns where it stands"


@check
def the_driver_decides_on_the_pipeline(hand: Hand) -> None:
    """Without compute shaders there are no layers: another intensity restarts."""
    has_compute = hand.session._context.has_compute
    assert hand.session.pipeline == ("compute" if has_compute else "fragment")
    restarts = hand.session.restarts
    move(hand, "intensity##lamp", 2.0)
    hand.settle()
    assert hand.session.last_cost is (Cost.RELIGHT if has_compute else Cost.RESTART)
    assert hand.session.restarts == restarts + (not has_compute)


def kept(file: Path) -> dict[str, Any]:
    """What a file of preferences says; nothing if there is none."""
    return dict(json.loads(file.read_text())) if file.exists() else {}


@check
def a_relit_picture_is_that_of_a_fresh_render(hand: Hand) -> None:
    hand.there(lambda: hand.session.edit(samples=8, seed=2))
    hand.until(lambda: hand.session.is_done)
    dim, restarts = hand.pixels(), hand.session.restarts
    move(hand, "intensity##lamp", 2.0)
    hand.until(lambda: hand.session.last_cost is Cost.RELIGHT, frames=3)
    hand.ctx.yield_()
    bright = hand.pixels()
    assert hand.session.restarts == restarts
    assert bright.mean() > 1.1 * dim.mean()

    def render() -> Any:
        session = hand.session
        fresh = Renderer(session.scene, session.settings, session._context)
        codes = fresh.render().display()
        fresh.release()
        return codes

    assert (hand.there(render) == bright[..., :3]).all()


@check
def bounces_are_tuned_live_and_shown_alone(hand: Hand) -> None:
    ctx = hand.ctx
    hand.there(lambda: hand.session.edit(bounces=5))
    ctx.set_ref("Controls")
    ctx.item_click("bounces live")
    hand.settle()
    restarts, samples, whole = hand.session.restarts, hand.session.samples, hand.pixels()
    ctx.item_input_value("bounces", 0)
    hand.settle()
    assert hand.session.restarts == restarts
    assert hand.session.samples > samples
    black = hand.pixels()[..., :3]
    assert (black.max(axis=2) > 0).mean() < 0.2 < (whole[..., :3].max(axis=2) > 0).mean(), "lamps"
    ctx.item_input_value("bounces", 5)
    hand.settle()
    ctx.combo_click("shown/bounce 2 alone")
    hand.settle()
    alone = hand.pixels()[..., :3]
    assert 0.05 * whole.mean() < alone.mean() < 0.9 * whole.mean()
    ctx.combo_click("shown/all light")
    ctx.item_click("bounces live")
    hand.settle()
    assert hand.session.restarts == restarts + 1


def place_of(hand: Hand, point: Any) -> tuple[float, float]:
    """Where a point of the scene is on the screen."""
    left, top, width, height = hand.window.app.rectangle
    camera = hand.session.scene.camera
    right, up, forward = (
        np.dot(axis, np.subtract(point, camera.position)) for axis in axes(camera)
    )
    scale = 1 / (forward * math.tan(math.radians(camera.fov) / 2))
    x, y = 0.5 + 0.5 * right * scale, 0.5 - 0.5 * up * scale  # the picture is square
    return left + x * width, top + y * height


def click(hand: Hand, point: Any, times: int = 1) -> None:
    hand.ctx.mouse_move_to_pos(place_of(hand, point))
    hand.ctx.yield_()
    if times == 1:
        hand.ctx.mouse_click(0)
    else:
        hand.ctx.mouse_double_click(0)
    hand.ctx.yield_(2)


def ball(hand: Hand) -> tuple[int, Any]:
    """The first ball of the scene, and its number."""
    objects = hand.session.scene.objects
    return next((n, shape) for n, shape in enumerate(objects) if shape.shape == "sphere")


@check
def a_click_selects_and_restarts_nothing(hand: Hand) -> None:
    number, shape = ball(hand)
    restarts = hand.session.restarts
    click(hand, shape.center)
    assert hand.window.app.selected == number
    assert hand.session.restarts == restarts
    hand.ctx.key_press(imgui.Key.f.value)
    hand.settle()
    assert hand.session.scene.camera.look_at == shape.center
    right, up, _ = axes(hand.session.scene.camera)
    click(hand, shape.center - 0.92 * shape.radius * (right + up))  # beside it, off the handles
    assert hand.window.app.selected != number


@check
def a_double_click_sets_the_pivot(hand: Hand) -> None:
    number, shape = ball(hand)
    hand.session.paused, before = True, hand.window.app.pivot
    for _ in range(5):  # a frame of a busy machine may be longer than a double click
        if hand.window.app.pivot == before:
            click(hand, shape.center, times=2)
    assert abs(math.dist(hand.window.app.pivot, shape.center) / shape.radius - 1) < 0.02
    assert hand.session.scene.objects[number] == shape


@check
def the_gizmo_moves_what_is_selected_without_compiling(hand: Hand) -> None:
    number, shape = ball(hand)
    hand.window.app.selected = number
    hand.ctx.yield_(2)
    restarts, camera = hand.session.restarts, hand.session.scene.camera
    x, y = place_of(hand, shape.center)
    hand.ctx.mouse_move_to_pos((x, y))
    hand.ctx.yield_(4)
    assert hand.there(lambda: is_held(hand.window.app))
    hand.ctx.mouse_down(0)
    hand.ctx.mouse_move_to_pos((x + 20, y))
    hand.ctx.mouse_move_to_pos((x + 40, y))
    hand.ctx.mouse_up(0)
    hand.settle()
    moved = hand.session.scene.objects[number]
    step = np.subtract(moved.center, shape.center)  # type: ignore[union-attr]
    assert np.dot(step, axes(camera)[0]) > 0.05
    assert hand.session.scene.camera == camera
    assert hand.session.restarts > restarts
    assert hand.session.last_cost is Cost.RESTART
    hand.ctx.item_click("//Controls/undo")
    hand.settle()
    assert hand.session.scene.objects[number] == shape
    hand.window.app.selected = None


@check
def an_object_is_edited_in_the_panel(hand: Hand) -> None:
    number, shape = ball(hand)
    hand.window.app.selected = number
    hand.ctx.yield_(3)
    hand.ctx.set_ref("Controls")
    before = hand.pixels()
    hand.ctx.item_input_value(f"radius##shape {number}", 0.2)
    hand.settle()
    assert hand.session.scene.objects[number].radius == 0.2  # type: ignore[union-attr]
    hand.ctx.item_input_value(f"color##material {shape.material}/##X", 0.1)
    hand.settle()
    assert hand.session.scene.materials[shape.material].color[0] == 0.1  # type: ignore[union-attr]
    assert (hand.pixels() != before).any()
    hand.window.app.selected = None


@check
def a_scene_is_saved_and_read_again_when_its_file_changes(hand: Hand) -> None:
    app, file = hand.window.app, Path.cwd() / "edited.toml"
    hand.there(lambda: hand.session.edit(bounces=3))
    hand.there(partial(setattr, app, "scene_path", str(file)))
    hand.there(app.save_scene)
    hand.there(partial(app.open, str(file)))
    hand.settle()
    assert hand.session.settings.bounces == 3
    text = file.read_text()
    file.write_text(text.replace("[7.6, 7.2, 6.5]", "[1.0, 2.0, 3.0]"))
    hand.until(lambda: hand.session.scene.materials["lamp"].emission == (1.0, 2.0, 3.0))  # type: ignore[union-attr]
    file.write_text("nonsense")
    hand.until(lambda: "edited.toml" in hand.session.problem)
    file.write_text(text)
    hand.until(lambda: hand.session.problem == "")
    reopen(hand)


@check
def a_shader_that_is_broken_on_disk_is_told_and_the_old_kernel_goes_on(hand: Hand) -> None:
    """The files are a copy: see tests/test_window.py."""
    session = hand.session
    for name, word in (("path.glsl", "undeclared"), ("display.frag", "undeclared")):
        file = folder("shaders_glsl") / name
        whole = file.read_text()
        number = whole.count("\n") + 1
        restarts = session.restarts
        file.write_text(f"{whole}float broken() {{ return {word}; }}\n")
        until_told(hand, f"{name}:{number}:")
        assert word in session.problem
        assert session.restarts == restarts
        edits: tuple[dict[str, Any], ...] = ({"seed": restarts + 5}, {"method": "nee"})
        for edit in edits:
            hand.there(partial(session.edit, **edit))
            hand.settle()
            assert session.samples > 0, "edits go on with the texts that compiled"
        file.unlink()
        hand.ctx.yield_(30)
        file.write_text(whole)
        hand.until(lambda: session.problem == "", frames=1000)
        hand.settle()
    assert hand.pixels()[..., :3].mean() > 10


def until_told(hand: Hand, problem: str) -> None:
    hand.until(lambda: problem in hand.session.problem, frames=1000)


@check
def the_figures_tell_error_and_forecast(hand: Hand) -> None:
    app = hand.window.app
    hand.until(lambda: len(app.progress.looks) > 2, frames=2000)
    told = "\n".join(figures(app))
    assert "million samples/s" in told
    assert "ms a frame" in told
    assert re.search(r"error [\d.]+ % \([\d.]+ to [\d.]+\)", told), told
    assert "of rendering" in told or "is reached" in told
    assert app.progress.looks[0].error > app.progress.looks[-1].error > 0


@check
def a_kept_picture_is_compared_by_a_wipe(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    ctx.set_ref("Controls")
    hand.session.paused = True
    ctx.yield_(2)
    before = hand.pixels()
    ctx.item_click("keep this picture")
    ctx.yield_(2)
    ctx.item_input_value("exposure", 3.0)
    ctx.item_input_value("wipe", 0.25)
    hand.settle()
    assert app.show.wipe == 0.25
    assert (hand.pixels() != before).any()
    assert (hand.there(lambda: read_kept(app.picture)) == before).all()
    ctx.item_click("forget it")
    ctx.yield_(2)
    assert app.picture.kept_name == 0


@check
def the_wipe_shows_one_picture_on_each_side_of_a_line_that_is_dragged(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    hand.session.paused = True
    ctx.item_click("//Controls/keep this picture")
    hand.there(lambda: hand.session.edit(exposure=-20.0))  # black
    left, top, width, height = app.rectangle
    ctx.mouse_move_to_pos((left + 0.5 * width, top + 0.5 * height))
    ctx.mouse_down(0)
    ctx.mouse_move_to_pos((left + 0.5 * width - 40, top + 0.5 * height))
    ctx.mouse_up(0)
    ctx.mouse_move_to_pos((left + 0.9 * width, top - 10))
    ctx.yield_(2)
    assert app.show.wipe == pytest.approx(0.5 - 40 / width, abs=4 / width)
    row = hand.screen()[int(top + 0.75 * height), int(left) : int(left + width)].astype(int)
    edge = round(app.show.wipe * width)
    near = row[edge - 4 : edge + 5].min(axis=1)
    assert near.max() > 200, "a white line"
    assert near.min() < 60, "with a dark rim"
    assert row[20 : edge - 20].mean() > 60 > 5 > row[edge + 20 : -20].mean()
    ctx.item_click("//Controls/forget it")
    ctx.yield_(2)
    row = hand.screen()[int(top + 0.75 * height), int(left) : int(left + width)]
    assert row[20:-20].max() < 5


def views(hand: Hand, *names: str) -> list[Any]:
    """The picture as each of these views shows it."""
    shown = []
    hand.ctx.set_ref("Controls")
    for name in names:
        hand.ctx.combo_click(f"view/{name}")
        hand.until(lambda name=name: hand.window.app.show.drawn == name)  # type: ignore[misc]
        shown.append(hand.pixels()[..., :3])
    return shown


@check
def views_cost_no_sample_and_have_a_legend(hand: Hand) -> None:
    show = hand.window.app.show
    hand.until(lambda: show.mean is not None and hand.session.samples >= 32, frames=2000)
    hand.session.paused = True
    restarts, samples = hand.session.restarts, hand.session.samples
    left, top, _, height = hand.window.app.rectangle
    corner = (slice(int(top + height - 70), int(top + height)), slice(int(left), int(left + 300)))
    plain = hand.screen()[corner]
    error, dropped = views(hand, "error", "dropped")
    scale = 255 * ERROR.color(np.geomspace(ERROR.low, ERROR.high, 500))
    apart = np.abs(error[:, :, None].astype(int) - scale).max(axis=3).min(axis=2)
    assert apart.max() <= 2, "colours of the scale alone"
    assert len(np.unique(error)) > 50
    assert (dropped.max(axis=2) == dropped.min(axis=2)).all(), "no sample was dropped"
    legend = hand.screen()[corner]
    assert (legend != plain).mean() > 0.5
    assert (legend.min(axis=2) > 180).sum() > 60, "white words"
    (again,) = views(hand, "picture")
    assert again.mean() > dropped.mean()
    assert (hand.session.restarts, hand.session.samples) == (restarts, samples)


@check
def the_difference_is_white_where_nothing_changed(hand: Hand) -> None:
    app, ctx = hand.window.app, hand.ctx
    ctx.set_ref("Controls")
    hand.there(lambda: hand.session.edit(samples=6))
    hand.until(lambda: hand.session.is_done)
    ctx.item_click("keep this picture")
    ctx.item_click("show the difference")
    hand.until(lambda: app.show.drawn == "difference")
    assert np.ptp(hand.pixels()[..., :3].reshape(-1, 3), axis=0).max() == 0, "nothing changed"
    restarts = hand.session.restarts
    move(hand, "intensity##lamp", 3.0)
    hand.settle()
    assert hand.session.restarts == restarts
    red = hand.pixels().astype(int)
    assert (red[..., 0] > red[..., 2]).mean() > 0.95, "all is lighter than it was"
    move(hand, "intensity##lamp", 1.0)
    number, shape = ball(hand)
    app.selected = number
    ctx.yield_(3)
    ctx.item_input_value(f"color##material {shape.material}/##X", 0.1)
    hand.settle()
    hand.until(lambda: hand.session.is_done and app.show.is_done(hand.session))
    ctx.yield_(2)
    assert app.show.drawn == "difference"
    mixed = hand.pixels()[..., :3].astype(int)
    white = (np.abs(mixed - 247) <= 1).all(axis=2)
    assert 0.02 < white.mean() < 0.9
    assert (mixed[..., 2] > mixed[..., 0] + 30).mean() > 0.05, "blue: darker than it was"
    ctx.item_input_value("strongest", 5.0)
    ctx.yield_(2)
    assert np.abs(hand.pixels()[..., :3].astype(int) - 247).mean() < np.abs(mixed - 247).mean()
    ctx.item_click("show the difference")
    ctx.item_click("forget it")
    hand.until(lambda: app.show.drawn == "picture")
    app.selected = None


def read_kept(picture: Picture) -> Any:
    assert picture._kept
    width, height = picture._kept.size
    return np.frombuffer(picture._kept.read(), np.uint8).reshape(height, width, 4)[::-1].copy()


@check
def the_frame_rate_is_what_is_preferred(hand: Hand) -> None:
    app = hand.window.app
    for wanted, expected in ((20, 20), (0, 10 if hand.session._context.is_software else 30)):
        hand.there(partial(app.prefer, replaced(app.preferences, frame_rate=wanted)))
        hand.ctx.yield_(2)
        assert app.pace.frames_per_second == expected
