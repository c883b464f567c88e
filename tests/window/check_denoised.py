"""The denoised picture in the window: made alongside frames, with its error, never in files."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.error.estimate import DARK
from glrt.rendering.screen.false_colors import ERROR
from glrt.settings import settings_for
from tests.window.check_views import views
from tests.window.hand import Hand, check

SIDE = 96
SAMPLES = 1024  # more than pass while a view is chosen


@check
def the_picture_is_denoised_with_its_error_reported_and_saved_plain(hand: Hand) -> None:
    show, session = hand.window.app.show, hand.session
    hand.there(lambda: session.edit(width=SIDE, height=SIDE, samples=SAMPLES))
    hand.ctx.set_ref("Controls")
    hand.ctx.combo_click("view/denoised")
    hand.settle()
    assert show.drawn == "picture", "nothing is filtered yet"
    assert "Denoised from" in show.notice(session)
    hand.until(lambda: show.drawn == "denoised")
    hand.session.paused = True
    hand.ctx.yield_(2)
    hand.until(lambda: show.is_done(session))
    assert f"{session.samples} samples by" in show.notice(session), "the last one, too"
    assert "in 95 of 100 cases" in show.notice(session)
    denoised = hand.pixels()[..., :3].astype(int)
    (errors,) = views(hand, "denoised error")
    found = show.denoised.found
    assert found
    scale = 255 * ERROR.color(np.geomspace(ERROR.low, ERROR.high, 500))
    apart = np.abs(errors[:, :, None].astype(int) - scale).max(axis=3).min(axis=2)
    assert apart.max() <= 2, "colours of the scale alone"
    known, light = found.denoised(), found.denoised().radiance
    relative = np.square(known.error_map) / (np.square(light) + DARK * light.mean() ** 2)
    wanted = 255 * ERROR.color(np.sqrt(relative.mean(axis=-1)))
    assert np.abs(errors - wanted).max() < 4
    saved = hand.there(session.image)
    assert saved.denoising is None
    assert saved.recipe
    assert saved.recipe.settings == settings_for(session.settings, aov=())
    (plain,) = views(hand, "picture")
    assert roughness(plain.astype(int)) > 2 * roughness(denoised)
    assert abs(plain.mean() - denoised.mean()) < 2, "as bright, and as the screen shows it"


def roughness(codes: NDArray[Any]) -> float:
    """Mean of second differences across, in codes: noise more than edges."""
    return float(np.abs(codes[:, :-2] - 2 * codes[:, 1:-1] + codes[:, 2:]).mean())


@check
def a_drag_shows_the_plain_picture_until_it_is_denoised_again(hand: Hand) -> None:
    show, session = hand.window.app.show, hand.session
    hand.there(lambda: session.edit(width=SIDE, height=SIDE, samples=SAMPLES))
    (before,) = views(hand, "denoised")
    hand.there(lambda: session.edit(bounces=1))
    hand.ctx.yield_(3)
    assert show.drawn == "picture"
    hand.until(lambda: show.drawn == "denoised")
    assert (hand.pixels()[..., :3] != before).mean() > 0.2
