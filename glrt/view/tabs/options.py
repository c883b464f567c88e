"""Part `Window`: how the window behaves and looks, and the legend of costs."""

from imgui_bundle import imgui

from glrt.view.app import App
from glrt.view.tabs.kept import FREE_SAMPLES, MOVING, PREFERENCES, preferences_rows
from glrt.view.widgets.cost_badges import legend


def draw_options(app: App) -> None:
    """Draw the preferences that stand nowhere else, and the classes of cost."""
    shown = [c for c in PREFERENCES if c.name not in (*MOVING, *FREE_SAMPLES)]
    preferences_rows(app, shown)
    imgui.separator_text("what an edit costs")
    legend()
