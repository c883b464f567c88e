"""Views: sides of the scene, views that are kept, and cameras of files."""

from functools import partial
from pathlib import Path

from imgui_bundle import imgui

from glrt.view.controls import replaced
from glrt.view.viewport.sides import SIDES, ball_of
from tests.scene.test_file_cameras import cameras
from tests.window.check_palette import find
from tests.window.check_toolbar import WIDE, sized
from tests.window.gestures import press, reopen
from tests.window.hand import Hand, check

CTRL, ALT = imgui.Key.mod_ctrl.value, imgui.Key.mod_alt.value


def choose(hand: Hand, item: str) -> None:
    """Choose an item of the menu of the camera."""
    hand.ctx.item_click("//Picture/camera")
    hand.ctx.yield_(3)
    hand.ctx.item_click(f"//$FOCUSED/{item}")
    hand.ctx.yield_(3)


@check
def the_scene_is_seen_from_its_sides(hand: Hand) -> None:
    app, start = hand.window.app, hand.session.scene.camera
    ball = ball_of(hand.session.scene)
    assert ball
    with sized(hand, WIDE):
        for side in ("left", "top"):
            choose(hand, side)
            assert app.camera.look_at == ball.center == app.pivot
            away = [a - b for a, b in zip(app.camera.position, ball.center, strict=True)]
            largest = max(range(3), key=lambda axis: abs(away[axis]))
            assert SIDES[side][largest] * away[largest] > 0
        choose(hand, "first view")
        assert app.camera == start
    assert find(hand, "see the back")[0] == "see the back of the scene"
    press(hand, imgui.Key.enter)
    assert app.camera.position[2] < ball.center[2]
    hand.there(app.undo)


@check
def a_click_on_an_axis_looks_along_it(hand: Hand) -> None:
    app, ctx, start = hand.window.app, hand.ctx, hand.session.scene.camera
    ctx.mouse_move("//Picture/picture")
    assert not ctx.item_exists("//Picture/axis right")
    hand.there(lambda: app.prefer(replaced(app.preferences, axes=True)))
    ctx.yield_(3)
    for side in ("right", "top", "back"):
        ctx.item_click(f"//Picture/axis {side}")
        ctx.yield_(3)
        away = [a - b for a, b in zip(app.camera.position, app.pivot, strict=True)]
        largest = max(range(3), key=lambda axis: abs(away[axis]))
        assert SIDES[side][largest] * away[largest] > 0
        assert app.camera.up[1] > 0, "it is turned, not rolled"
        assert app.selected is None, "the click is not one on the picture"
    hand.there(app.home)
    assert app.camera == start
    hand.there(lambda: app.prefer(replaced(app.preferences, axes=False)))


@check
def views_are_kept_and_come_back_by_digits(hand: Hand) -> None:
    app, start, scale = hand.window.app, hand.session.scene.camera, hand.window.app.zoom
    app.views.clear()
    press(hand, imgui.Key._3, ALT)
    assert "No view 3" in app.messages.last
    press(hand, imgui.Key._3, CTRL)
    assert app.messages.last == "View 3 is kept; Alt+3 comes back to it"
    hand.there(lambda: app.turn(0.1, 0.1, about_camera=False))
    other = app.camera
    press(hand, imgui.Key._1, CTRL)
    press(hand, imgui.Key._3, ALT)
    assert app.camera == start
    assert app.pivot == start.look_at
    with sized(hand, WIDE):
        choose(hand, "view 1")
        assert app.camera == other
        choose(hand, "keep this view")
    assert sorted(app.views) == [1, 2, 3]
    assert app.zoom == scale, "digits without Ctrl and Alt zoom"
    hand.there(partial(app.files.open, "lamps"))
    assert app.views == {}, "another scene has its own"
    reopen(hand)
    assert sorted(app.views) == [1, 2, 3]
    app.views.clear()


@check
def cameras_of_a_file_are_in_the_menu(hand: Hand) -> None:
    app, file = hand.window.app, Path.cwd() / "set.glb"
    file.write_bytes(cameras().glb())
    hand.there(partial(app.files.open, str(file)))
    hand.settle()
    with sized(hand, WIDE):
        choose(hand, "crane##1")
        assert app.camera.position == (9, 9, 12)
    press(hand, imgui.Key.k, CTRL)
    hand.ctx.key_chars("camera still")
    hand.ctx.yield_(3)
    press(hand, imgui.Key.enter)
    assert app.camera.position == (1, 2, 3)
    reopen(hand)
