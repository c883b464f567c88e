"""Sections of the panel that choose a view, and keep a picture to compare with."""

from typing import get_args

from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.compared_picture import Pairing
from glrt.view.controls import Control, choice, switch
from glrt.view.viewport.views import HELP, VIEWS
from glrt.view.widgets.fields import beside, button, edited, tip

VIEW = choice("view", HELP, Cost.FREE, VIEWS)
_MOST = "the difference, relative to the kept picture, that is shown in the strongest colour"
MOST = Control(
    "strongest", "number", _MOST, Cost.FREE, unit="1", low=0.001, high=10.0, slider=(0.01, 2.0)
)

_GOES_ON = (
    "A gathers samples too, by the scene and settings that it was kept with, in turns with B; "
    "both restart, and the plot shows both errors over their own time"
)
GOES_ON = switch("render_A_too", _GOES_ON, Cost.RECOMPILE)
_PAIRING = "what A and B have in common: seconds of rendering, or samples of each pixel"
PAIRING = choice("pairing", _PAIRING, Cost.FREE, get_args(Pairing))
_WIPE = "where the line parts A, to its left, from B: as a share of the picture's width"
WIPE = Control("wipe", "number", _WIPE, Cost.FREE, low=0.0, high=1.0, slider=(0.0, 1.0))
_DIFFERENCE = (
    "the change by the edits since then, pixel by pixel; at the samples that A was kept with, the "
    "noise of both is the same and drops out; for more samples A is rendered again after B, which "
    "takes as long as B did"
)
DIFFERENCE = switch("show the difference", _DIFFERENCE, Cost.FREE)
BESIDE = switch("side_by_side", "A to the left of B, instead of a line between them", Cost.FREE)


def draw_view(app: App) -> None:
    """Draw the choice of the view of the render."""
    view = edited(VIEW, app.show.view)
    if view is not None:
        app.show.view = view
    if app.show.view == "difference":
        most = edited(MOST, app.show.most)
        app.show.most = app.show.most if most is None else most


def _slot(app: App) -> None:
    """Draw whether A gathers samples, how it is shown with B, and the button to swap them."""
    goes_on = edited(GOES_ON, app.pair.slot is not None)
    if goes_on is not None:
        app.pair.go_on(goes_on)
    if app.pair.slot:
        pairing = edited(PAIRING, app.pair.pairing)
        app.pair.pairing = app.pair.pairing if pairing is None else pairing
    wanted = edited(BESIDE, app.pair.is_beside)
    app.pair.is_beside = app.pair.is_beside if wanted is None else wanted
    if button("swap A and B"):
        app.pair.swap()
    tip("Go on editing A; what is edited now becomes A. Both restart; undo brings B back")


def draw_compare(app: App) -> None:
    """Draw the widgets to keep a picture, to wipe between A and B, or to show their difference."""
    show = app.show
    if button("keep this picture", bool(app.picture.name)):
        app.keep()
    tip("Keep the picture as A: a line parts it from the one that is edited, B, to its right")
    beside("forget it")
    if button("forget it", show.kept is not None):
        show.forget()
        show.view = "picture" if show.view == "difference" else show.view
        app.pair.go_on(False)
    if not show.kept:
        return
    _slot(app)
    wipe = edited(WIPE, show.wipe)
    show.wipe = show.wipe if wipe is None else wipe
    is_difference = edited(DIFFERENCE, show.view == "difference")
    if is_difference is not None:
        show.view = "difference" if is_difference else "picture"
