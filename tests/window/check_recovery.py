"""Unsaved edits: kept while they are unsaved, and offered in a box over the picture."""

from functools import partial
from pathlib import Path

from imgui_bundle import imgui

from glrt.scene.scenefile.toml_writer import scene_with
from glrt.view.edits.scene_edits import without_objects
from glrt.view.recovery.contents import text_of
from glrt.view.recovery.headers import Header, recovery_folder
from glrt.view.recovery.offers import offers_for
from glrt.view.recovery.question import NAME
from tests.window.gestures import press
from tests.window.hand import Hand, check

CTRL = imgui.Key.mod_ctrl.value


def offer(hand: Hand, edits: int) -> Path:
    """Leave what a window leaves that died without one object, and let this window find it."""
    session, folder = hand.session, recovery_folder()
    scene = without_objects(scene_with(session.scene, session.settings), {0})
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "other.toml"
    file.write_text(text_of(Header("cornell", 0.0, edits), scene))
    hand.there(lambda: setattr(hand.window.recovery, "offers", offers_for("cornell", folder)))
    hand.ctx.yield_(4)
    return file


@check
def an_edit_is_kept_until_it_is_undone(hand: Hand) -> None:
    file = hand.window.recovery.file
    hand.there(lambda: hand.session.edit(without_objects(hand.session.scene, {0})))
    hand.until(file.exists)
    press(hand, imgui.Key.z, CTRL)
    hand.until(lambda: not file.exists())


@check
def edits_of_a_window_that_died_are_restored_by_a_click(hand: Hand) -> None:
    before = hand.session.state
    file = offer(hand, 3)
    hand.ctx.item_click(f"//{NAME}/restore")
    hand.until(lambda: hand.session.scene.objects == before.scene.objects[1:])
    hand.until(lambda: not file.exists())
    press(hand, imgui.Key.z, CTRL)
    assert hand.session.state == before


@check
def the_question_on_edits_lies_in_the_picture_and_is_answered_once(hand: Hand) -> None:
    recovery = hand.window.recovery
    for answer, is_left in (("discard", False), ("#CLOSE", True)):
        file = offer(hand, 1)
        box, picture = (hand.ctx.window_info(f"//{name}").window for name in (NAME, "Picture"))
        assert box
        assert picture
        assert picture.pos.x < box.pos.x
        assert box.pos.x + box.size.x < picture.pos.x + picture.size.x
        assert box.pos.y + box.size.y < picture.pos.y + picture.size.y
        hand.ctx.item_click(f"//{NAME}/{answer}")
        hand.until(partial(lambda: not recovery.offers))
        assert file.exists() == is_left
    file.unlink()
