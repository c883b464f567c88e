"""Places where newcomers stumbled in trials: the window's messages, and what lies in sight."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from imgui_bundle import imgui

from glrt.view import file_dialogs
from glrt.view.controls import replaced
from glrt.view.tabs import panel
from glrt.view.tabs.sections import TABS
from glrt.view.widgets import fields
from tests.window.check_layout import resized
from tests.window.check_toolbar import sized
from tests.window.gestures import add, ball, click, press, reported_lines
from tests.window.hand import Hand, check

CTRL, SHIFT = imgui.Key.mod_ctrl.value, imgui.Key.mod_shift.value
SMALLEST = (640, 400)
ROWS = (
    *(f"{tab}##tab" for tab in TABS),
    *("restart", "home", "fit", "16:1"),
    *("object", "add", "delete", "focus here", "make unique", "new##material"),
    *("keep this picture", "forget it", "swap A and B", "side by side", "wipe"),
    *("show the difference", "scene", "recent", "##open", "##save", "##scene file"),
    *("open", "...##open", "save picture", "...##save", "save scene", "...##scene file"),
    *("copy recipe", "paste recipe", "reset keys"),
)


@check
def undo_and_redo_report_what_they_change(hand: Hand) -> None:
    app, (number, shape) = hand.window.app, ball(hand)
    app.selected = number
    hand.ctx.yield_(3)
    hand.ctx.item_click(f"//Controls/hidden##shape {number}")
    hand.settle()
    with reported_lines() as lines:
        press(hand, imgui.Key.z, CTRL)
        assert f"Undo: hidden of {shape.name}" in lines
        press(hand, imgui.Key.y, CTRL)
        assert f"Redo: hidden of {shape.name}" in lines
    hand.there(app.undo)
    app.selected = None


@check
def a_copy_is_seen_next_to_its_original(hand: Hand) -> None:
    app, (number, shape) = hand.window.app, ball(hand)
    click(hand, shape.center)
    press(hand, imgui.Key.d, CTRL)
    hand.settle()
    copy: Any = hand.session.scene.objects[-1]
    assert np.linalg.norm(np.subtract(copy.center, shape.center)) > 2 * shape.radius
    assert app.selected == len(hand.session.scene.objects) - 1
    click(hand, copy.center + np.array([0.0, 0.5 * copy.radius, 0.0]))
    assert app.selected != number
    app.selected = None


def unfold(hand: Hand, title: str) -> None:
    """Fold a part, go to the end of its tab, and unfold it there."""
    hand.ctx.item_close(f"//Controls/{title}")
    hand.ctx.scroll_to_bottom("//Controls")
    hand.ctx.yield_(3)
    hand.ctx.item_open(f"//Controls/{title}")
    hand.ctx.yield_(4)


@check
def a_part_that_is_unfolded_is_scrolled_into_sight(hand: Hand) -> None:
    ctx = hand.ctx
    panel: Any = ctx.window_info("//Controls").window
    with sized(hand, SMALLEST):
        unfold(hand, "Frame")
        info = ctx.item_info("//Controls/height")
        assert info.rect_full.max.y < panel.pos.y + panel.size.y, "its end, since it is short"
        unfold(hand, "Mouse and keys")
        info = ctx.item_info("//Controls/Mouse and keys")
        assert panel.pos.y <= info.rect_full.min.y < panel.pos.y + 0.35 * panel.size.y, "its title"


@check
def a_name_is_typed_at_once_where_a_file_is_saved(hand: Hand) -> None:
    files, before = hand.window.app.files, file_dialogs.PROGRAMS
    file_dialogs.PROGRAMS = ()  # type: ignore[assignment]
    try:
        press(hand, imgui.Key.s, CTRL | SHIFT)
        hand.ctx.yield_(4)
        hand.ctx.key_chars("typed at once")
        hand.ctx.key_press(imgui.Key.enter.value)
        hand.until(lambda: not files.dialogs.is_open)
    finally:
        file_dialogs.PROGRAMS = before
    assert files.source == str(Path.cwd() / "typed at once.toml")


@check
def a_list_reports_what_its_words_mean(hand: Hand) -> None:
    app, (number, shape) = hand.window.app, ball(hand)
    app.selected = number
    hand.ctx.yield_(3)
    told: list[str] = []
    written = imgui.text_disabled

    def heard(text: str) -> None:
        told.append(text)
        written(text)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fields.imgui, "text_disabled", heard)  # type: ignore[attr-defined]
        hand.ctx.item_click(f"//Controls/type##material {shape.material}")
        hand.ctx.yield_(3)
        assert {"matte", "glass, water", "a lamp"} <= set(told)
        press(hand, imgui.Key.escape)
        hand.ctx.item_click("//Controls/material")
        hand.ctx.yield_(3)
        assert {"lambertian", "dielectric", "light"} <= set(told)
        press(hand, imgui.Key.escape)
    app.selected = None


@check
def buttons_of_a_material_stay_where_they_are(hand: Hand) -> None:
    app, (number, _) = hand.window.app, ball(hand)
    app.selected = number
    hand.ctx.yield_(3)
    before = hand.ctx.item_info("//Controls/make unique").rect_full.min
    hand.ctx.item_click("//Controls/make unique")
    hand.ctx.yield_(3)
    after = hand.ctx.item_info("//Controls/make unique").rect_full.min
    assert after.x == before.x
    hand.there(app.undo)
    app.selected = None


@check
def a_lamp_is_dimmed_where_it_is_edited(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    add(hand, "lamp")
    hand.settle()
    shape = app.selected_shape
    assert shape
    group = session.scene.finish(shape).group
    samples, restarts = session.samples, session.restarts
    hand.ctx.set_ref("Controls")
    hand.ctx.item_input_value(f"intensity##{group} of object", 0.25)
    hand.settle()
    assert session.scene.light_groups[str(group)] == 0.25
    assert session.samples >= samples
    assert session.restarts == restarts, "it is relit"
    app.selected = None


@check
def rows_of_a_narrow_panel_are_not_cut(hand: Hand) -> None:
    """In a window of 640 x 400: buttons of all parts, lists and names end inside of the panel."""
    app, (number, shape), ctx = hand.window.app, ball(hand), hand.ctx
    usual = tuple(map(int, hand.there(lambda: tuple(imgui.get_io().display_size))))
    hand.there(app.keep)
    app.select(number)
    resized(hand, SMALLEST)
    ctx.yield_(3)
    right = hand.there(lambda: imgui.internal.find_window_by_name("Controls").inner_clip_rect.max.x)
    try:
        for row in (*ROWS, f"name##shape {number}", f"type##material {shape.material}"):
            info = ctx.item_info(f"//Controls/{row}")
            is_typed = row.startswith(("name##", "type##", "##"))
            box = info.rect_clipped if is_typed else info.rect_full
            assert box.max.x <= right + 1, row
            if is_typed:
                assert box.max.x - box.min.x > 5 * imgui.get_font_size(), row
    finally:
        resized(hand, (usual[0], usual[1]))
        app.selected = None


@check
def the_box_of_the_tour_stays_in_a_window_that_gets_another_size(hand: Hand) -> None:
    app = hand.window.app
    usual = tuple(map(int, hand.there(lambda: tuple(imgui.get_io().display_size))))
    app.preferences = replaced(app.preferences, tour=True)
    app.tour_step = 0
    hand.ctx.yield_(4)
    try:
        for size in (SMALLEST, (usual[0], usual[1])):
            resized(hand, size)
            box = hand.there(lambda: imgui.internal.find_window_by_name("###tour"))
            assert box.pos.x >= 0
            assert box.pos.x + box.size.x <= size[0]
            assert box.pos.x + box.size.x > size[0] - 40, "in the upper right"
    finally:
        resized(hand, (usual[0], usual[1]))
        app.tour_step = None


@check
def what_becomes_of_a_is_said(hand: Hand) -> None:
    """A picture that is saved is B alone; the next picture that is kept is not rendered further."""
    app, ctx, saved = hand.window.app, hand.ctx, Path("b-alone.png")
    hand.until(lambda: hand.session.samples > 0)
    ctx.item_click("//Controls/keep this picture")
    ctx.item_click("//Controls/render A too")
    hand.until(lambda: app.pair.picture is not None)
    with reported_lines() as lines:
        hand.there(lambda: app.files.save_picture(str(saved)))
        hand.until(lambda: any(line.endswith(": B alone, without A") for line in lines))
        ctx.item_click("//Controls/keep this picture")
        hand.until(lambda: "A is this picture now, and is not rendered further" in lines)
    ctx.item_click("//Controls/forget it")
    ctx.yield_(2)
    with reported_lines() as lines:
        hand.there(lambda: app.files.save_picture(str(saved)))
        hand.until(lambda: any(line.startswith("Saved b-alone.png") for line in lines))
    assert not any("B alone" in line for line in lines)
    saved.unlink()


@check
def undo_without_an_edit_says_so(hand: Hand) -> None:
    app = hand.window.app
    hand.there(lambda: app.session.history.forget())
    with reported_lines() as lines:
        press(hand, imgui.Key.z, CTRL)
        assert "There is nothing more to undo" in lines
        press(hand, imgui.Key.y, CTRL)
        assert "There is nothing more to redo" in lines


@check
def a_long_caution_is_two_lines_of_the_panel(hand: Hand) -> None:
    caution = "objects[0] overlaps itself in one plane, up to rounding, and so on. " * 5
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(panel, "_found", lambda *_: [])
        top = hand.ctx.item_info("//Controls/Paths").rect_full.min.y
        patch.setattr(panel, "_found", lambda *_: [caution])
        hand.ctx.yield_(3)
        moved = hand.ctx.item_info("//Controls/Paths").rect_full.min.y - top
    assert 0 < moved < 3 * imgui.get_text_line_height_with_spacing()
