"""Parts `Samples`, `Display` and `Frame`: what the picture gets, how it is shown, and its size."""

from typing import Literal

from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.panels.compare import draw_view
from glrt.view.state.costs import reach_of_size
from glrt.view.tabs.kept import (
    FREE_SAMPLES,
    PREFERENCES,
    SETTINGS,
    edit,
    preferences_rows,
    settings_rows,
)
from glrt.view.widgets.cost_badges import tag
from glrt.view.widgets.fields import button, edited_fields, tip

DISPLAY = ("exposure", "tonemap")
FRAME: tuple[Literal["width"], Literal["height"]] = ("width", "height")


def draw_samples(app: App) -> None:
    """Draw the number of samples, how many a frame adds, and the button that restarts."""
    settings_rows(app, ("samples",))
    preferences_rows(app, [c for c in PREFERENCES if c.name in FREE_SAMPLES])
    if button("restart"):
        app.restart()
    tip("Discard all samples and begin again, with new figures of the picture")
    tag(Cost.RESTART)


def draw_display(app: App) -> None:
    """Draw exposure, tone mapping and the view."""
    settings_rows(app, DISPLAY)
    draw_view(app)


def draw_frame(app: App) -> None:
    """Draw the size of the picture."""
    session = app.session
    usual = Cost.RECOMPILE if session.lacks_room else Cost.RESTART
    sides = tuple(SETTINGS[side].costing(usual, reach_of_size(session, side)) for side in FRAME)
    opened = session.opened.settings
    edit(app, edited_fields(sides, dict(session.settings), opened=opened))
