"""Fog in an object: put there, thinned, taken away, as a user does it."""

import numpy as np
from imgui_bundle import imgui

from glrt.scene.shapes.sphere import Sphere
from glrt.view.controls import replaced
from glrt.view.panels.media import VALUES
from tests.window.gestures import add, press, retype
from tests.window.hand import Hand, check


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
    add(hand, "sphere")
    hand.settle()
    hand.ctx.set_ref("Controls")
    hand.ctx.item_click("fill with fog")
    hand.settle()
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
