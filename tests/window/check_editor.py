"""Objects, materials and lamps: added, copied, renamed, changed and removed, as a user does it."""

from pathlib import Path
from typing import Any

import numpy as np
from imgui_bundle import imgui

from glrt.view.edits.new_objects import ADDED
from glrt.view.panels.viewport import _OUTLINE
from tests.support.gltf_files import textured_square
from tests.window.check_newcomer import SMALLEST
from tests.window.check_toolbar import sized
from tests.window.gestures import (
    add,
    answer,
    ball,
    click,
    drop,
    place_of,
    press,
    reopen,
    retype,
    scroll_to,
    type_name,
)
from tests.window.hand import Hand, check

CTRL = imgui.Key.mod_ctrl.value


@check
def cornell_gets_a_metal_ball_in_five_clicks(hand: Hand) -> None:
    session, before = hand.session, hand.pixels()
    add(hand, "sphere")  # two clicks, as is the next
    retype(hand, "sphere", "metal")
    hand.settle()
    assert session.scene.objects[-1].material == "sphere"
    assert session.scene.materials["sphere"].type == "metal"
    assert (hand.pixels() != before).mean() > 0.02
    assert hand.window.app.selected == len(session.scene.objects) - 1
    for _ in range(2):
        press(hand, imgui.Key.z, CTRL)
    assert session.scene == session.opened.scene


@check
def one_of_each_kind_is_added_and_undone(hand: Hand) -> None:
    session, count = hand.session, len(hand.session.scene.objects)
    for kind in ADDED:
        add(hand, kind)
        hand.settle()
        assert len(session.scene.objects) == count + 1, kind
        assert not session.problem, kind
        press(hand, imgui.Key.z, CTRL)
        assert session.scene == session.opened.scene


@check
def an_added_lamp_is_dimmed_by_itself(hand: Hand) -> None:
    session, ctx = hand.session, hand.ctx
    add(hand, "lamp")
    hand.settle()
    ctx.set_ref("Controls")
    ctx.item_input_value("lamp 2 intensity##lamp 2", 0.0)
    hand.settle()
    assert session.scene.lights == {"lamp 2": 0.0}


@check
def a_selection_is_outlined_copied_and_deleted_by_keys(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    number, shape = ball(hand)
    before = outlined(hand)
    click(hand, shape.center)
    assert outlined(hand) > before + 100
    press(hand, imgui.Key.d, CTRL)
    hand.settle()
    assert len(session.scene.objects) == len(session.opened.scene.objects) + 1
    copy = session.scene.objects[-1]
    assert (copy.name, copy.material) == (f"{shape.name} 2", shape.material)
    assert app.selected == len(session.scene.objects) - 1
    press(hand, imgui.Key.delete)
    assert session.scene == session.opened.scene
    assert app.selected is None
    click(hand, shape.center)
    press(hand, imgui.Key.delete)
    hand.settle()
    assert shape not in session.scene.objects
    press(hand, imgui.Key.z, CTRL)
    assert session.scene == session.opened.scene
    assert app.selected == number  # what comes back is selected


def outlined(hand: Hand) -> int:
    """Pixels of the window in the colour of outlines."""
    wanted = np.array(_OUTLINE[1][:3]) * 255
    return int((np.abs(hand.screen() - wanted).max(axis=2) < 12).sum())


@check
def a_click_in_the_picture_opens_the_panel_at_the_object(hand: Hand) -> None:
    ctx = hand.ctx
    ctx.item_close("//Controls/Object")
    _, shape = ball(hand)
    click(hand, shape.center)
    ctx.yield_(3)
    info = ctx.item_info("//Controls/duplicate")
    panel: Any = ctx.window_info("//Controls").window
    assert panel.pos.y < info.rect_full.min.y < panel.pos.y + panel.size.y


@check
def names_are_typed(hand: Hand) -> None:
    session = hand.session
    number, shape = ball(hand)
    hand.window.app.selected = number
    hand.settle()
    samples, restarts = session.samples, session.restarts
    type_name(hand, f"name##shape {number}", "big ball")
    assert session.scene.objects[number].name == "big ball"
    type_name(hand, f"name##material {shape.material}", "chalk")
    assert session.scene.objects[number].material == "chalk"
    assert shape.material not in session.scene.materials
    walls = [thing for thing in session.scene.objects if thing.material == "chalk"]
    assert len(walls) > 1  # all objects of the material follow
    hand.settle()
    assert not session.problem
    assert session.restarts == restarts  # no sample is lost
    assert session.samples >= samples


@check
def a_widget_stays_where_it_is_when_rows_come_and_go(hand: Hand) -> None:
    """Types have more values, or fewer, and one of them is that of a lamp."""
    session, ctx = hand.session, hand.ctx
    _, shape = ball(hand)
    click(hand, shape.center)
    widget = f"//Controls/type##material {shape.material}"
    scroll_to(hand, widget)
    for kind in ("light", "dielectric", "principled", "lambertian"):
        before = ctx.item_info(widget).rect_full.min.y
        retype(hand, shape.material, kind)
        ctx.yield_(3)
        assert session.scene.materials[shape.material].type == kind
        assert abs(ctx.item_info(widget).rect_full.min.y - before) < 2, kind
    hand.settle()


@check
def a_part_that_is_closed_stays_under_the_mouse_and_the_panel_scrolls_freely(hand: Hand) -> None:
    ctx, title = hand.ctx, "//Controls/Frame"
    with sized(hand, SMALLEST):
        ctx.item_open(title)
        ctx.scroll_to_bottom("//Controls")
        ctx.yield_(3)
        place = ctx.item_info(title).rect_full.min.y
        ctx.item_click(title)
        ctx.yield_(3)
        assert abs(ctx.item_info(title).rect_full.min.y - place) < 2
        panel: Any = ctx.window_info("//Controls").window
        scroll = panel.scroll.y
        ctx.mouse_wheel_y(3.0)
        ctx.yield_(3)
        assert panel.scroll.y < scroll
        ctx.scroll_to_top("//Controls")
        ctx.yield_(2)
        assert panel.scroll.y == 0


@check
def a_material_is_made_unique_new_and_removed(hand: Hand) -> None:
    session, ctx = hand.session, hand.ctx
    number, shape = ball(hand)
    hand.window.app.selected = number
    ctx.yield_(2)
    ctx.set_ref("Controls")
    ctx.item_click("make unique")
    ctx.yield_(2)
    assert session.scene.objects[number].material == f"{shape.material} 2"
    ctx.item_click("new##material")
    ctx.yield_(2)
    assert session.scene.objects[number].material == "material"
    ctx.item_click("###remove unused")
    ctx.yield_(2)
    assert f"{shape.material} 2" not in session.scene.materials
    assert shape.material in session.scene.materials
    hand.settle()
    assert not session.problem


@check
def a_type_that_does_not_fit_is_reported_and_nothing_changes(hand: Hand) -> None:
    lamp = next(n for n, t in enumerate(hand.session.scene.objects) if t.shape == "quad")
    hand.window.app.selected = lamp
    hand.ctx.yield_(2)
    retype(hand, "lamp", "dielectric")
    assert "quad" in hand.session.problem
    assert hand.session.scene == hand.session.opened.scene


@check
def one_of_two_lamps_gets_a_group_of_its_own(hand: Hand) -> None:
    session, ctx = hand.session, hand.ctx
    lamp = next(n for n, t in enumerate(session.scene.objects) if t.shape == "quad")
    hand.window.app.selected = lamp
    ctx.yield_(2)
    press(hand, imgui.Key.d, CTRL)
    ctx.set_ref("Controls")
    ctx.item_click("own group")
    hand.settle()
    assert session.scene.objects[-1].group == "lamp 2"
    assert list(session.scene.light_groups) == ["lamp", "lamp 2", "background"]


@check
def a_model_that_is_dropped_is_added_or_opened(hand: Hand) -> None:
    session, ctx, app = hand.session, hand.ctx, hand.window.app
    file = Path.cwd() / "square.glb"
    file.write_bytes(textured_square().glb())
    drop(hand, file)
    answer(hand, "add")
    hand.settle()
    mesh: Any = session.scene.objects[-1]
    assert (mesh.shape, mesh.name) == ("mesh", "square")
    x, y = place_of(hand, mesh.middle)
    left, top, width, height = app.rectangle
    assert left < x < left + width
    assert top < y < top + height
    hand.there(lambda: session.edit(session.opened.scene))
    drop(hand, file)
    answer(hand, "open")
    hand.settle()
    assert app.files.source == str(file)
    assert [thing.shape for thing in session.scene.objects][:1] == ["mesh"]
    ctx.yield_()
    reopen(hand)
