"""Methods with probes in the window: their control, and what an edit of a lamp costs there."""

from glrt.scene.scene import with_lights
from glrt.settings import Cost
from tests.window.gestures import move
from tests.window.hand import Hand, check

LOOKED_AT = 20  # samples: more than one set of probes lights


@check
def probes_light_the_picture_of_the_method_ddgi(hand: Hand) -> None:
    session = hand.session
    hand.ctx.set_ref("Controls")
    move(hand, "method/ddgi", None)
    hand.until(lambda: session.samples >= LOOKED_AT)
    assert session.settings.method == "ddgi"
    assert session.layering == "none"
    assert not session.problem
    assert hand.pixels()[..., :3].mean() > 20
    move(hand, "probes", 2)
    hand.until(lambda: session.samples >= LOOKED_AT)
    assert session.settings.probes == 2
    assert session.last_cost is Cost.RESTART
    assert not session.problem
    move(hand, "method/gather", None)
    hand.until(lambda: session.samples >= LOOKED_AT)
    assert (session.settings.method, session.settings.probes) == ("gather", 2)
    assert not session.problem
    assert hand.pixels()[..., :3].mean() > 20


@check
def points_are_reused_as_the_panel_says(hand: Hand) -> None:
    """A crop, whose samples would lack those around, is refused, and changes nothing."""
    session = hand.session
    hand.there(lambda: session.edit(method="resampled", probes=2))
    hand.until(lambda: session.samples >= LOOKED_AT)
    hand.ctx.set_ref("Controls")
    move(hand, "reuse/both", None)
    hand.until(lambda: session.samples >= LOOKED_AT)
    assert (session.settings.reuse, session.settings.unbiased) == ("both", True)
    assert session.last_cost is Cost.RECOMPILE
    move(hand, "unbiased", None)
    hand.until(lambda: session.samples >= LOOKED_AT)
    assert not session.settings.unbiased
    assert not session.problem
    assert hand.pixels()[..., :3].mean() > 20
    hand.there(lambda: session.edit(crop=(0, 0, 16, 16)))
    hand.until(lambda: bool(session.problem))
    assert "reuse of points" in str(session.problem).lower()
    assert session.settings.crop is None


@check
def a_lamp_over_probes_restarts_the_picture(hand: Hand) -> None:
    """Their light is that of all lamps in one: it is not kept by layers."""
    session = hand.session
    hand.there(lambda: session.edit(method="ddgi", probes=2))
    hand.until(lambda: session.samples >= LOOKED_AT)
    before = hand.pixels()[..., :3].mean()
    hand.there(lambda: session.edit(with_lights(session.scene, {"lamp": 0.2})))
    hand.until(lambda: session.samples >= LOOKED_AT)
    assert session.last_cost is Cost.RESTART
    assert hand.pixels()[..., :3].mean() < before


@check
def what_does_not_go_with_probes_is_refused_by_name(hand: Hand) -> None:
    session = hand.session
    hand.there(lambda: session.edit(method="ddgi", probes=2))
    hand.until(lambda: session.samples > 0)
    hand.there(lambda: session.edit(sampler="independent"))
    hand.until(lambda: bool(session.problem))
    assert "a method with probes" in str(session.problem).lower()
