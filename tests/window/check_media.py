"""Fog in an object: put there, thinned, taken away, as a user does it."""

import numpy as np
from imgui_bundle import imgui

from glrt.scene.density import Density
from glrt.scene.shapes.sphere import Sphere
from glrt.view import file_dialogs
from glrt.view.controls import replaced
from glrt.view.edits.media_edits import with_medium
from glrt.view.panels.media import VALUES
from tests.window.check_files import BROWSER
from tests.window.gestures import add, press, retype
from tests.window.hand import Hand, check


def add_fog(hand: Hand) -> None:
    """Add a ball and fill it with fog."""
    add(hand, "sphere")
    hand.settle()
    hand.ctx.set_ref("Controls")
    hand.ctx.item_click("fill with fog")
    hand.settle()


@check
def an_object_is_filled_with_fog_which_is_thinned_and_left(hand: Hand) -> None:
    session, ctx = hand.session, hand.ctx
    add(hand, "sphere")
    hand.settle()
    before = hand.pixels()
    ctx.set_ref("Controls")
    ctx.item_click("fill with fog")
    hand.settle()
    thing = session.scene.objects[-1]
    assert (thing.material, thing.medium) == ("none", "fog")
    assert not session.problem
    assert (hand.pixels() != before).mean() > 0.02
    ctx.item_input_value("anisotropy##medium fog", 0.5)
    hand.settle()
    assert session.scene.media["fog"].anisotropy == 0.5
    ctx.combo_click(f"medium inside##shape {len(session.scene.objects) - 1}/vacuum")
    hand.settle()
    assert session.scene.objects[-1].medium is None
    ctx.combo_click(f"medium inside##shape {len(session.scene.objects) - 1}/fog")
    hand.settle()
    retype(hand, "none", "lambertian")
    hand.settle()
    assert session.scene.objects[-1].medium is None
    assert not session.problem
    assert {control.name for control in VALUES} == {
        *("scattering", "absorption", "anisotropy", "emission")
    }


@check
def fog_that_is_moved_across_other_fog_is_reported_and_comes_back_by_undo(hand: Hand) -> None:
    session = hand.session
    add_fog(hand)
    before = session.scene
    fog = before.objects[-1]
    assert isinstance(fog, Sphere)
    beside = tuple(np.add(fog.center, [fog.radius, 0, 0]).tolist())
    other = replaced(fog, center=beside)
    hand.there(lambda: session.edit(replaced(before, objects=(*before.objects, other))))
    hand.until(lambda: bool(session.problem))
    assert "cross" in session.problem
    press(hand, imgui.Key.z, imgui.Key.mod_ctrl.value)
    hand.settle()
    assert session.scene == before


@check
def a_grid_is_shown_by_colours_whose_knots_are_changed(hand: Hand) -> None:
    session, ctx = hand.session, hand.ctx
    add_fog(hand)
    grid = Density(np.linspace(0, 2, 64, dtype=np.float32).reshape(4, 4, 4))
    hand.there(lambda: session.edit(with_medium(session.scene, "fog", density=grid)))
    hand.settle()
    ctx.item_input_value("scale##density fog", 0.5)
    hand.settle()
    density = session.scene.media["fog"].density
    assert density
    assert density.scale == 0.5
    even = hand.pixels()
    ctx.item_click("colour by density##fog")
    hand.settle()
    assert (hand.pixels() != even).mean() > 0.02
    transfer = session.scene.media["fog"].transfer
    assert transfer
    assert (transfer.values, transfer.opacities) == ((0.0, 1.0), (0.0, 0.9))
    ctx.item_input_value("opacity##fog 1", 0.25)
    hand.settle()

    ctx.scroll_to_item_y("opacity##fog 1")
    ctx.yield_(4)
    changed = session.scene.media["fog"].transfer
    assert changed == transfer.model_copy(update={"opacities": (0.0, 0.25)})
    assert not session.problem
    ctx.item_click("colour by density##fog")
    hand.settle()
    assert session.scene.media["fog"].transfer is None
    assert any(session.scene.media["fog"].scattering)


@check
def a_grid_is_chosen_for_the_fog_in_a_ball(hand: Hand) -> None:
    session, ctx, before = hand.session, hand.ctx, file_dialogs.PROGRAMS
    add_fog(hand)
    even = hand.pixels()
    np.save("half.npy", np.repeat(np.array([[[0, 4]]], np.float32), 8, axis=0))
    file_dialogs.PROGRAMS = ()  # type: ignore[assignment]
    try:
        ctx.item_click("grid...")
        ctx.yield_(3)
        ctx.item_click(f"{BROWSER}/**/half.npy")
        ctx.item_click(f"{BROWSER}/open")
        hand.until(lambda: session.scene.media["fog"].density is not None)
    finally:
        file_dialogs.PROGRAMS = before
    hand.settle()
    assert not session.problem
    density = session.scene.media["fog"].density
    assert density
    assert (density.file.file, density.scale) == ("half.npy", 0.25)
    assert (hand.pixels() != even).mean() > 0.01
    ctx.set_ref("Controls")
    assert ctx.item_exists("another grid...")


@check
def fog_with_a_priority_takes_the_place_of_other_fog(hand: Hand) -> None:
    """The switch gives it one, a slider raises it, and the other fog may then cross it."""
    session = hand.session
    add_fog(hand)
    number = len(session.scene.objects) - 1
    hand.ctx.item_click(f"has priority##shape {number}")
    hand.settle()
    assert session.scene.objects[-1].priority == 0
    hand.ctx.item_input_value(f"priority##shape {number}", 2)
    hand.settle()
    before = session.scene
    fog = before.objects[-1]
    assert isinstance(fog, Sphere)
    assert fog.priority == 2
    beside = tuple(np.add(fog.center, [0, fog.radius, 0]).tolist())
    other = replaced(fog, center=beside, priority=None)
    hand.there(lambda: session.edit(replaced(before, objects=(*before.objects, other))))
    hand.settle()
    assert not session.problem, session.problem
    hand.ctx.item_click(f"has priority##shape {number}")
    hand.until(lambda: bool(session.problem))
    assert "priority" in session.problem
