"""Other views of the picture, as numbers in colours."""

from typing import Any

import numpy as np

from glrt.rendering.false_colors import ERROR
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
