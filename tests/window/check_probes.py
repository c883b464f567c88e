"""Methods with probes in the window: their control, and what an edit of a lamp costs there."""

import pytest
from imgui_bundle import imgui

from glrt.core.errors import UsageError
from glrt.scene.scene import with_lights
from glrt.settings import Cost
from glrt.view.panels.plots import figures
from glrt.view.state.session import Session
from tests.window.check_views import views
from tests.window.gestures import move
from tests.window.hand import Hand, check

LOOKED_AT = 20  # samples: more than one set of probes lights


def until_lit(hand: Hand) -> None:
    """Let the window take in all edits, and light several sets of probes."""
    session = hand.session
    hand.until(lambda: not session.is_behind and session.samples >= LOOKED_AT)


@check
def probes_light_the_picture_of_the_method_ddgi(hand: Hand) -> None:
    session = hand.session
    hand.ctx.set_ref("Controls")
    move(hand, "method/ddgi", None)
    until_lit(hand)
    assert session.settings.method == "ddgi"
    assert session.layering == "none"
    assert not session.problem
    assert hand.pixels()[..., :3].mean() > 20
    assert any("of noise alone" in line for line in figures(hand.window.app))
    move(hand, "probes", 2)
    until_lit(hand)
    assert session.settings.probes == 2
    assert session.last_cost is Cost.RESTART
    assert not session.problem
    move(hand, "method/gather", None)
    until_lit(hand)
    assert (session.settings.method, session.settings.probes) == ("gather", 2)
    assert not session.problem
    assert hand.pixels()[..., :3].mean() > 20


@check
def points_are_reused_as_the_panel_says(hand: Hand) -> None:
    """A crop, whose samples would lack those around, is refused, and changes nothing."""
    session = hand.session
    hand.there(lambda: session.edit(method="resampled", probes=2))
    until_lit(hand)
    hand.ctx.set_ref("Controls")
    move(hand, "reuse/both", None)
    until_lit(hand)
    assert (session.settings.reuse, session.settings.unbiased) == ("both", True)
    assert session.last_cost is Cost.RECOMPILE
    move(hand, "unbiased", None)
    until_lit(hand)
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
    until_lit(hand)
    before = hand.pixels()[..., :3].mean()
    hand.there(lambda: session.edit(with_lights(session.scene, {"lamp": 0.2})))
    until_lit(hand)
    assert session.last_cost is Cost.RESTART
    assert hand.pixels()[..., :3].mean() < before


@check
def what_does_not_go_with_probes_is_refused_by_name(hand: Hand) -> None:
    session = hand.session
    hand.there(lambda: session.edit(method="ddgi", probes=2))
    until_lit(hand)
    hand.there(lambda: session.edit(sampler="independent"))
    hand.until(lambda: bool(session.problem))
    assert "a method with probes" in str(session.problem).lower()


def refusal(session: Session) -> str:
    """Why there is no picture; "" where there is one."""
    try:
        session.image()
    except UsageError as error:
        return str(error)
    return ""


@check
def probes_are_live_while_edits_follow_one_another(hand: Hand) -> None:
    """They lag behind a lamp; the picture is not saved; then they rest."""
    session = hand.session
    hand.there(lambda: session.edit(method="ddgi", probes=2))
    until_lit(hand)
    assert session.lag == 0.0
    refusals: list[str] = []

    def lags() -> bool:
        if session.lag:
            refusals.append(refusal(session))
        return session.lag > 0.0

    hand.there(lambda: session.edit(with_lights(session.scene, {"lamp": 0.2})))
    hand.until(lags)
    assert "live" in refusals[0]
    until_lit(hand)
    assert session.lag == 0.0
    assert hand.there(session.image).samples >= LOOKED_AT


@check
def probes_are_shown_as_balls(hand: Hand) -> None:
    """Where the method has any; with the light that they hold, or with distances and a scale."""
    session = hand.session
    show = hand.window.app.show
    hand.until(lambda: session.samples > 0)
    hand.there(lambda: setattr(show, "view", "probes"))
    hand.ctx.yield_(4)
    assert show.drawn == "picture"
    assert "has no probes" in show.notice(session)
    hand.there(lambda: session.edit(method="ddgi", probes=3, samples=LOOKED_AT))
    hand.until(lambda: show.drawn == "probes" and session.samples == LOOKED_AT)
    plain, light, distances = views(hand, "picture", "probes", "probe distances")
    changed = (light != plain).any(axis=2)
    assert 0.02 < changed.mean() < 0.5, "balls over the picture"
    colored = distances.max(axis=2).astype(int) - distances.min(axis=2) > 30
    assert 0.02 < colored.mean() < 0.5
    assert (colored & ~changed).mean() < 0.02, "at the same places"
    assert distances[~colored].max() < 80, "over a dark picture"


@check
def a_method_that_mixes_the_light_of_lamps_is_named_as_the_reason(hand: Hand) -> None:
    """A smaller picture would not help."""
    texts: list[str] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(imgui, "text_disabled", texts.append)
        hand.there(lambda: hand.session.edit(method="ddgi"))
        hand.turn_to("Light")
        until_lit(hand)
        assert any("Probes hold the light of all lamps" in text for text in texts)
        assert not any("A smaller picture has room" in text for text in texts)
