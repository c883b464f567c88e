"""Other views of the picture, as numbers in colours."""

from functools import partial
from typing import Any, get_args

import numpy as np
import pytest
from imgui_bundle import imgui

from glrt.gpu import driver_checks
from glrt.rendering.screen.false_colors import ERROR, HISTORY, MASK, WEIGHT
from glrt.settings import Aov, Cost
from glrt.view.controls import replaced
from glrt.view.panels import legend
from glrt.view.panels.inspector import pixel_text
from tests.window.gestures import press, reported_lines
from tests.window.hand import Hand, check


def views(hand: Hand, *names: str) -> list[Any]:
    """The picture as each of these views shows it."""
    shown = []
    hand.ctx.set_ref("Controls")
    for name in names:
        hand.ctx.combo_click(f"view/{name}")
        hand.until(lambda name=name: hand.window.app.show.drawn == name)  # type: ignore[misc]
        shown.append(hand.pixels()[..., :3])
    return shown


@check
def views_cost_no_sample_and_have_a_legend(hand: Hand) -> None:
    show = hand.window.app.show
    hand.until(lambda: show.mean is not None and hand.session.samples >= 32)
    hand.session.paused = True
    restarts, samples = hand.session.restarts, hand.session.samples
    left, top, _, height = hand.window.app.rectangle
    corner = (slice(int(top + height - 70), int(top + height)), slice(int(left), int(left + 300)))
    plain = hand.screen()[corner]
    error, dropped = views(hand, "error", "dropped")
    scale = 255 * ERROR.color(np.geomspace(ERROR.low, ERROR.high, 500))
    apart = np.abs(error[:, :, None].astype(int) - scale).max(axis=3).min(axis=2)
    assert apart.max() <= 2, "colours of the scale alone"
    assert len(np.unique(error)) > 50
    assert (dropped.max(axis=2) == dropped.min(axis=2)).all(), "no sample was dropped"
    legend = hand.screen()[corner]
    assert (legend != plain).mean() > 0.5
    assert (legend.min(axis=2) > 180).sum() > 60, "white words"
    (again,) = views(hand, "picture")
    assert again.mean() > dropped.mean()
    assert (hand.session.restarts, hand.session.samples) == (restarts, samples)


@check
def views_of_aovs_cost_no_sample_and_are_not_saved(hand: Hand) -> None:
    """Each shows its own picture, also of a render that is complete; a scene edit restarts it."""
    session = hand.session
    hand.until(lambda: session.samples >= 4)
    hand.there(lambda: session.edit(samples=session.samples))
    hand.settle()
    restarts, samples = session.restarts, session.samples
    shown = views(hand, *get_args(Aov))
    *others, volume = shown
    for number, picture in enumerate(others):
        assert picture.std() > 5, get_args(Aov)[number]
        assert all((picture != other).mean() > 0.05 for other in shown[:number])
    assert not volume.any(), "the scene has no medium"
    assert (session.restarts, session.samples) == (restarts, samples)
    image = hand.there(session.image)
    assert not image.aovs
    assert image.recipe
    assert image.recipe.settings.aov == ()
    objects = shown[get_args(Aov).index("object")]
    assert len(np.unique(objects.reshape(-1, 3), axis=0)) < 10, "a colour for each object"
    views(hand, "picture")
    assert hand.session.renderer
    hand.until(lambda: hand.session.renderer.settings.aov == ())  # type: ignore[union-attr]


@check
def bounces_until_the_end_are_shown_on_a_scale_and_reported_of_a_pixel(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    hand.until(lambda: session.samples >= session.known_from)
    hand.there(lambda: session.edit(samples=session.samples))
    hand.settle()
    views(hand, "bounces")
    hand.until(lambda: app.show.is_done(session))
    hand.ctx.yield_(2)
    shown = hand.pixels()[..., :3]
    assert session.renderer
    image = hand.there(session.renderer.plain_image)
    found = image.aovs["bounces"]
    expected = 255 * app.show.scale.color(found.value)
    assert app.show.scale.high == session.settings.bounces
    assert np.abs(shown.astype(int) - expected).max() <= 2
    assert found.value.std() > 0.5
    assert found.stderr is not None
    told = hand.there(lambda: pixel_text(app, 20.5 / 40, 31.5 / 40))
    mean, error = found.value[31, 20], found.stderr[31, 20]
    assert told[-1] == f"bounces until the end {mean:.4g} +- {error:.2g}"
    hand.there(lambda: session.edit(bounces=2, samples=session.samples))
    hand.settle()
    hand.until(lambda: app.show.scale.high == 2 and app.show.drawn == "bounces")


@check
def counts_of_more_bounces_than_are_shown_are_labelled(hand: Hand) -> None:
    """A lower limit is relit from layers: the counts are those of the paths that were traced."""
    app, session = hand.window.app, hand.session
    hand.there(lambda: session.edit(bounces=5))
    hand.ctx.set_ref("Controls")
    hand.ctx.item_click("bounces live")
    hand.settle()
    views(hand, "bounces")
    hand.until(lambda: session.samples > 20)
    session.paused = True
    hand.ctx.yield_(3)
    before, counts = hand.pixels(), hand.there(lambda: pixel_text(app, 0.5, 0.8))[-1]
    titles: list[str] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(legend, "_draw", lambda title, *_: titles.append(title))
        hand.ctx.yield_(2)
        assert titles[-1] == "bounces of a path until its end, mean"
        hand.there(lambda: session.edit(bounces=2))
        hand.ctx.yield_(4)
        assert session.last_cost is Cost.RELIGHT
        assert titles[-1] == "bounces of a path until its end, mean, of paths of up to 5"
    assert hand.there(lambda: pixel_text(app, 0.5, 0.8))[-1] == f"{counts}, of paths of up to 5"
    assert app.show.scale.high == 5
    assert np.array_equal(hand.pixels(), before), "the colours mean what they did"
    views(hand, "picture")
    hand.ctx.item_click("bounces live")


@check
def bounces_beyond_the_loop_limit_are_refused_once_and_the_picture_stays(hand: Hand) -> None:
    app, session = hand.window.app, hand.session
    driver = session.context.renderer, session.context.version
    limit = driver_checks._limits.get(driver, driver_checks.MOST_ROUNDS)
    driver_checks._limits[driver] = driver_checks.LLVMPIPE_ROUNDS  # whatever this driver's is
    hand.there(lambda: session.edit(bounces=700))
    hand.settle()
    app.show.view = "bounces"
    hand.until(lambda: bool(session.problem))
    assert "--aov bounces is beyond" in session.problem
    hand.until(lambda: app.show.view == "picture")
    hand.ctx.item_click("//Controls/dismiss")
    samples = session.samples
    hand.until(lambda: session.samples > samples)
    assert not session.problem
    driver_checks._limits[driver] = limit


@check
def a_view_that_is_on_its_way_is_reported(hand: Hand) -> None:
    app = hand.window.app
    hand.ctx.set_ref("Controls")
    with reported_lines() as lines:
        hand.ctx.combo_click("view/normal")
        hand.until(lambda: app.show.drawn == "normal")
        assert "The view normal comes with its first sample" in lines
        hand.ctx.yield_(2)
        lines.clear()
        hand.ctx.yield_(2)
        assert not any("comes with" in line for line in lines)


@check
def the_zoom_is_reported_with_the_key_that_ends_it(hand: Hand) -> None:
    with reported_lines() as lines:
        press(hand, imgui.Key._1)
        assert "zoom 1:1; 0 shows the whole picture" in lines
        press(hand, imgui.Key._0)
        lines.clear()
        hand.ctx.yield_(2)
        assert not any("zoom" in line for line in lines)


@check
def the_history_of_pixels_is_shown_while_it_counts(hand: Hand) -> None:
    """Samples of `reproject`; weights by `wrls`, a mask by `ataa`, and a sentence without them."""
    app, session = hand.window.app, hand.session

    def look(temporal: str) -> None:
        app.preferences = replaced(app.preferences, temporal=temporal)
        app.turn(0.01, 0.0, about_camera=False)

    for temporal, view, colors in (
        ("reproject", "history", HISTORY),
        ("ataa", "mask", MASK),
        ("wrls", "history", HISTORY),
        ("wrls", "weight", WEIGHT),
    ):
        session.paused = False
        hand.there(partial(look, temporal))
        hand.settle()
        hand.there(partial(look, temporal))
        hand.settle()
        session.paused = True
        (shown,) = views(hand, view)
        scale = 255 * colors.color(np.geomspace(colors.low, colors.high, 500))
        apart = np.abs(shown[:, :, None].astype(int) - scale).max(axis=3).min(axis=2)
        is_grey = np.ptp(shown, axis=2) <= 1
        assert np.where(is_grey, 0, apart).max() <= 2, (temporal, view)
        assert (~is_grey).mean() > (0.005 if view == "mask" else 0.5), (temporal, view)
    with reported_lines() as told:
        hand.there(partial(look, "taa"))
        hand.until(lambda: any("by temporal wrls alone" in text for text in told))
    views(hand, "picture")
