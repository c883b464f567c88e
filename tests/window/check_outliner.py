"""The list of what the scene holds: selected, hidden, locked, filtered, walked through by keys."""

from typing import Any

import pytest
from imgui_bundle import imgui

from glrt.settings import Cost
from glrt.view.outliner import contents, listing
from glrt.view.outliner.listing import OUTLINER
from glrt.view.panels.gizmo import is_held
from glrt.view.widgets.finder import FINDER
from tests.support.builders import MATTE, lamp, scene_of, sphere
from tests.window.gestures import ball, click, place_of, press, reopen
from tests.window.hand import Hand, check

CTRL = imgui.Key.mod_ctrl.value


def in_list(hand: Hand, item: str) -> None:
    """Click an item of the list, in whatever state the check before has left the panel."""
    hand.ctx.item_click(f"//Controls/**/{item}")
    hand.ctx.yield_(3)


def listed() -> list[tuple[str, int]]:
    return [(entry.name or entry.kind, entry.number) for entry in OUTLINER.entries]


@check
def a_row_selects_its_object_and_a_click_in_the_picture_its_row(hand: Hand) -> None:
    app, (number, shape) = hand.window.app, ball(hand)
    hand.ctx.scroll_to_item_y("//Controls/Contents")
    restarts = hand.session.restarts
    for other in (3, 0):
        in_list(hand, f"##object {other}")
        assert app.selected == other
        assert not app.is_to_be_seen, "the list stays under the mouse"
    click(hand, shape.center)
    assert OUTLINER.chosen == ("object", "", number)
    assert hand.session.restarts == restarts
    app.select(None)
    hand.ctx.yield_(2)
    assert OUTLINER.chosen is None


@check
def groups_fold_and_the_camera_leads_to_its_values(hand: Hand) -> None:
    app, lamps = hand.window.app, [7]
    hand.turn_to("Scene")
    hand.ctx.yield_(3)
    assert listed()[:4] == [("camera", 0), ("light", 1), ("object", *lamps), ("objects", 7)]
    in_list(hand, "##group light")
    assert ("object", 7) not in listed()
    app.select(7)
    hand.ctx.yield_(3)
    assert ("object", 7) in listed(), "what is selected is listed"
    in_list(hand, "##camera camera")
    assert app.selected is None
    assert FINDER.is_marking
    panel: Any = hand.ctx.window_info("//Controls").window
    title = hand.ctx.item_info("//Controls/Camera").rect_full
    assert panel.pos.y < title.min.y < panel.pos.y + panel.size.y


@check
def the_eye_hides_an_object_and_undo_shows_it(hand: Hand) -> None:
    session, (number, _) = hand.session, ball(hand)
    before = hand.pixels()
    hand.ctx.scroll_to_item_y("//Controls/Contents")
    in_list(hand, f"eye of object {number}")
    hand.settle()
    assert session.scene.objects[number].hidden
    assert hand.window.app.selected is None, "the eye selects nothing"
    assert session.last_cost in (Cost.RESTART, Cost.RECOMPILE)
    assert (hand.pixels() != before).mean() > 0.05
    in_list(hand, f"eye of object {number}")
    assert not session.scene.objects[number].hidden
    hand.there(session.undo)
    assert session.scene.objects[number].hidden
    hand.there(session.undo)
    assert session.scene == session.opened.scene


@check
def a_locked_object_is_neither_moved_nor_edited_nor_deleted(hand: Hand) -> None:
    app, session, (number, shape) = hand.window.app, hand.session, ball(hand)
    hand.ctx.scroll_to_item_y("//Controls/Contents")
    in_list(hand, f"lock of object {number}")
    assert session.state.locked == {number}
    app.select(number)
    hand.ctx.yield_(4)
    hand.ctx.mouse_move_to_pos(place_of(hand, shape.center))
    hand.ctx.yield_(4)
    assert not hand.there(lambda: is_held(app))
    flags = hand.ctx.item_info(f"//Controls/radius##shape {number}").item_flags
    assert flags & imgui.ItemFlags_.disabled.value
    press(hand, imgui.Key.delete)
    assert session.scene.objects[number] is shape
    assert "is locked" in session.problem
    assert app.session.undoes == f"Undo: lock of {shape.name}"
    hand.ctx.item_click("//Controls/unlock")
    assert not session.state.locked
    press(hand, imgui.Key.z, CTRL)
    assert session.state.locked == {number}
    press(hand, imgui.Key.z, CTRL)
    assert not session.state.locked
    app.select(None)


@check
def keys_walk_through_the_list_and_delete_from_it(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    camera, objects = session.scene.camera, session.scene.objects
    hand.ctx.scroll_to_item_y("//Controls/Contents")
    in_list(hand, "##object 1")
    for key, number in ((imgui.Key.down_arrow, 2), (imgui.Key.up_arrow, 1)):
        press(hand, key)
        assert app.selected == number
    press(hand, imgui.Key.up_arrow)
    press(hand, imgui.Key.up_arrow)
    assert OUTLINER.chosen == ("group", "objects", 0)
    press(hand, imgui.Key.left_arrow)
    assert listed()[-1] == ("objects", 7)
    press(hand, imgui.Key.right_arrow)
    press(hand, imgui.Key.down_arrow)
    assert app.selected == 0
    assert session.scene.camera == camera, "arrow keys do not walk meanwhile"
    press(hand, imgui.Key.delete)
    assert session.scene.objects == objects[1:]
    press(hand, imgui.Key.down_arrow)
    assert app.selected == 0, "the row that took its place"
    press(hand, imgui.Key.z, CTRL)
    assert session.scene.objects == objects
    click(hand, ball(hand)[1].center)
    press(hand, imgui.Key.up_arrow)
    assert session.scene.camera != camera, "in the picture they walk"
    in_list(hand, "##object 1")
    press(hand, imgui.Key.n)
    camera = session.scene.camera
    press(hand, imgui.Key.up_arrow)
    assert session.scene.camera != camera, "and without the list"
    press(hand, imgui.Key.n)
    app.select(None)


@check
def words_filter_the_list_also_if_the_panels_were_hidden(hand: Hand) -> None:
    app = hand.window.app
    press(hand, imgui.Key.n)
    assert app.is_picture_alone
    press(hand, imgui.Key.f, CTRL)
    hand.ctx.yield_(6)
    assert not app.is_picture_alone
    hand.ctx.key_chars("wall")
    hand.ctx.yield_(3)
    assert listed() == [("objects", 3), ("object", 2), ("object", 3), ("object", 4)]
    press(hand, imgui.Key.down_arrow)
    press(hand, imgui.Key.down_arrow)
    assert app.selected == 2
    hand.ctx.key_chars_replace("nothing")
    hand.ctx.yield_(2)
    assert listed() == []
    hand.ctx.key_chars_replace("")
    press(hand, imgui.Key.escape)
    OUTLINER.words = ""
    app.select(None)


@check
def a_frame_goes_through_the_rows_in_sight_alone(hand: Hand) -> None:
    app = hand.window.app
    crowd = [sphere([0.01 * n - 20, 0, -40], 0.1, "matte") for n in range(2000)]
    scene = scene_of(crowd, {"matte": MATTE, "lamp": lamp(1.0)}, background={"color": [1, 1, 1]})
    hand.there(lambda: hand.session.edit(scene))
    hand.settle()
    app.select(1234)
    asked: set[int] = set()
    inner = contents.text_of

    def counted(entry: Any, objects: Any) -> str:
        asked.add(entry.number)
        return inner(entry, objects)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(listing, "text_of", counted)
        hand.ctx.yield_(6)
    assert 1234 in asked, "the list scrolls to what is selected"
    assert len(asked) < 50
    app.select(None)
    reopen(hand)
