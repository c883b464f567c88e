"""Keys that are typed, and keys that are chosen."""

import pytest
from imgui_bundle import imgui

from glrt.view.controls import replaced
from glrt.view.panels.key_table import NAME
from glrt.view.state.keys import MEANING
from glrt.view.state.preferences import Preferences
from tests.window.gestures import drag, press
from tests.window.hand import Hand, check


@check
def keys_that_are_typed_into_a_box_move_nothing(hand: Hand) -> None:
    before = hand.session.scene.camera
    hand.ctx.item_open("//Controls/Files")
    hand.ctx.item_click("//Controls/##open")
    hand.ctx.key_chars_append("weasd")
    assert hand.session.scene.camera == before
    assert hand.window.app.files.open_path == "weasd"
    hand.ctx.key_press(imgui.Key.enter.value)
    hand.ctx.item_click("//Controls/open")
    hand.settle()
    assert "weasd" in hand.session.problem
    hand.ctx.item_click("//Controls/dismiss")
    assert hand.session.problem == ""


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
    hand.until(app.preferences_file.exists)
    hand.until(lambda: "ctrl+f5" in app.preferences_file.read_text())
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
def escape_closes_a_list_and_chooses_nothing(hand: Hand) -> None:
    ctx, before = hand.ctx, hand.session.settings
    ctx.set_ref("Controls")
    for reference in ("tonemap", "emission##lamp/hue"):
        ctx.item_click(reference)
        ctx.yield_(2)
        assert hand.there(is_open), reference
        press(hand, imgui.Key.escape)
        assert not hand.there(is_open), reference
    assert hand.session.settings == before


def is_open() -> bool:
    """Whether any list or box is open above the panel."""
    return len(imgui.get_current_context().open_popup_stack) > 0


@check
def keys_move_in_the_panel_and_change_its_widgets(hand: Hand) -> None:
    app, session, start = hand.window.app, hand.session, hand.session.scene.camera
    hand.ctx.item_click("//Controls/roulette")  # twice: as it was, and the one used last
    hand.ctx.item_click("//Controls/roulette")
    before = session.settings
    press(hand, imgui.Key.w)
    moved = session.scene.camera
    assert moved != start
    press(hand, imgui.Key.f6)
    assert app.navigates
    press(hand, imgui.Key.space)
    assert session.settings.roulette != before.roulette
    assert not session.paused  # which Space means in the picture
    for key in (imgui.Key.down_arrow, imgui.Key.w, imgui.Key.p):
        press(hand, key)
    assert session.scene.camera == moved
    assert not app.paths.is_choosing
    assert hand.there(lambda: imgui.get_current_context().nav_window.name) == "Controls"
    press(hand, imgui.Key.z, imgui.Key.mod_ctrl.value)  # with Ctrl, keys mean what they did
    assert session.settings == before
    press(hand, imgui.Key.escape)
    assert not app.navigates
    press(hand, imgui.Key.s)
    assert session.scene.camera != moved


@check
def escape_lets_go_of_a_widget_before_it_leaves_the_panel(hand: Hand) -> None:
    app, ctx, before = hand.window.app, hand.ctx, hand.session.settings
    ctx.item_click("//Controls/tonemap")
    ctx.yield_(2)
    press(hand, imgui.Key.escape)
    press(hand, imgui.Key.f6)
    press(hand, imgui.Key.space)
    assert hand.there(is_open)
    press(hand, imgui.Key.escape)
    assert not hand.there(is_open)
    assert app.navigates
    press(hand, imgui.Key.escape)
    assert not app.navigates
    assert hand.session.settings == before


@check
def a_click_in_the_picture_gives_it_the_keys_again(hand: Hand) -> None:
    app, start = hand.window.app, hand.session.scene.camera
    press(hand, imgui.Key.f6)
    assert app.navigates
    hand.ctx.mouse_move("//Picture/picture")
    hand.ctx.mouse_click(0)
    hand.ctx.yield_(2)
    assert not app.navigates
    press(hand, imgui.Key.right_arrow)
    assert hand.session.scene.camera != start


@check
def f1_shows_all_keys_over_the_window(hand: Hand) -> None:
    """As the user has chosen them; F1, Escape or a click elsewhere closes the box."""
    app = hand.window.app
    app.prefer(replaced(app.preferences, bindings={**app.preferences.bindings, "home": ("f9",)}))
    shown: dict[str, str] = {}

    def box() -> imgui.internal.Window | None:
        return imgui.internal.find_window_by_name(NAME)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("glrt.view.panels.key_table._table", lambda _, rows: shown.update(rows))
        press(hand, imgui.Key.f1)
    assert app.shows_keys
    assert shown["F9"] == MEANING["home"]
    assert shown["Ctrl+Y or Ctrl+Shift+Z"] == MEANING["redo"]
    assert shown["left drag"] == "turn about the pivot"
    hand.ctx.yield_(3)
    found = hand.there(box)
    assert found
    assert found.active
    area = hand.there(lambda: imgui.get_main_viewport().size)
    assert 0.3 * area.x < found.size.x <= area.x
    assert 0.2 * area.y < found.size.y <= area.y
    press(hand, imgui.Key.escape)
    assert not app.shows_keys
    press(hand, imgui.Key.f1)
    assert app.shows_keys
    press(hand, imgui.Key.f1)
    assert not app.shows_keys
    press(hand, imgui.Key.f1)
    hand.ctx.mouse_move_to_pos((area.x - 4, area.y - 4))
    hand.ctx.mouse_click(0)
    hand.ctx.yield_(2)
    assert not app.shows_keys


@check
def keys_change_the_exposure(hand: Hand) -> None:
    """By half a stop, no farther than the slider; several presses are one step of undo."""
    for _ in range(3):
        press(hand, imgui.Key.right_bracket)
    assert hand.session.settings.exposure == 1.5
    press(hand, imgui.Key.left_bracket)
    assert hand.session.settings.exposure == 1.0
    hand.session.edit(exposure=8.0)
    press(hand, imgui.Key.right_bracket)
    assert hand.session.settings.exposure == 8.0
    assert hand.session.problem == ""


@check
def a_key_hides_the_panels_and_shows_them_again(hand: Hand) -> None:
    """The picture has their room meanwhile."""

    def size() -> tuple[float, float]:
        window = imgui.internal.find_window_by_name("Picture")
        assert window
        return window.size.x, window.size.y

    before = hand.there(size)
    press(hand, imgui.Key.n)
    hand.ctx.yield_(4)
    alone = hand.there(size)
    area = hand.there(lambda: imgui.get_main_viewport().size)
    assert alone[0] > 0.95 * area.x > before[0]
    assert alone[1] > 0.95 * area.y > before[1]
    press(hand, imgui.Key.n)
    hand.ctx.yield_(4)
    assert hand.there(size) == pytest.approx(before, abs=2)
