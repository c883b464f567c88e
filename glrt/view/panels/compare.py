"""The parts of the panel that choose a view, and keep a picture to compare with."""

from imgui_bundle import hello_imgui, imgui

from glrt.settings import Cost
from glrt.view.app import App
from glrt.view.panels.widgets import button, edited, tip
from glrt.view.state.controls import Control
from glrt.view.viewport.views import HELP, VIEWS

VIEW = Control("view", "choice", HELP, Cost.FREE, "", None, None, None, VIEWS)
_MOST = "the difference, relative to the kept picture, that is shown in the strongest colour"
MOST = Control("strongest", "number", _MOST, Cost.FREE, "1", 0.001, 10.0, (0.01, 2.0))


def draw_view(app: App) -> None:
    """Which view of the render is shown."""
    view = edited(VIEW, app.show.view)
    if view is not None:
        app.show.view = view
    if app.show.view == "difference":
        most = edited(MOST, app.show.most)
        app.show.most = app.show.most if most is None else most


def draw_compare(app: App) -> None:
    """Keep a picture; wipe between it and the current one, or show the difference."""
    show = app.show
    if button("keep this picture", bool(app.picture.name)):
        app.keep()
    tip("Keep the picture as A: a line parts it from the one that is edited, B, to its right")
    imgui.same_line()
    if button("forget it", show.kept is not None):
        show.forget()
        show.view = "picture" if show.view == "difference" else show.view
    if not show.kept:
        return
    imgui.set_next_item_width(hello_imgui.em_size(9.5))
    _, show.wipe = imgui.slider_float("wipe", show.wipe, 0.0, 1.0, "%.2f")
    _, is_difference = imgui.checkbox("show the difference", show.view == "difference")
    tip(
        "What the edits since change, pixel by pixel. A is rendered again at the seeds and samples "
        "of B, so that the noise of both is the same and drops out: that takes as long as B did."
    )
    if is_difference != (show.view == "difference"):
        show.view = "difference" if is_difference else "picture"
