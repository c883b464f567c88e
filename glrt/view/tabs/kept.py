"""Rows of settings and of preferences, which keep what is edited."""

from dataclasses import replace
from typing import Any

from glrt.settings import Settings
from glrt.view.app import App
from glrt.view.controls import Control, controls_of, replaced
from glrt.view.state.preferences import Preferences
from glrt.view.widgets.fields import edited_fields

_METHODS = {  # a line on each, in the list of methods
    "naive": "directions alone; noisy",
    "nee": "points on lamps alone",
    "mis": "both, weighed: the usual one",
    "phong": "1975: one bounce, highlights",
    "blinn": "1977: one bounce, highlights",
    "whitted": "1980: mirrors and glass",
    "whitted_tree": "1980, all branches",
    "cook": "1984: blurred mirrors, lenses",
    "ddgi": "probes: little noise, blurred",
    "gather": "probes, one surface later",
    "resampled": "gather that reuses points",
    "hybrid": "rasterises, then effects",
    "march": "steps through smoke",
}
SETTINGS = {c.name: c for c in controls_of(Settings, leave_out=("crop", "denoise", "adaptive"))}
SETTINGS["sampler"] = replace(
    SETTINGS["sampler"],
    choices=tuple(it for it in SETTINGS["sampler"].choices if it != "shared"),
)
_METHOD = (
    "how light is found: the list has a line on each; `glrt inspect SCENE --error 5%` measures "
    "which is the cheapest to an error, and `glrt chart SCENE` draws the error of all over time"
)
SETTINGS["method"] = replace(
    SETTINGS["method"],
    told=tuple(_METHODS[name] for name in SETTINGS["method"].choices),
    help=_METHOD,
)
PREFERENCES = controls_of(Preferences, leave_out=("tab",))
MOVING = ("mode", "temporal", "predictor")  # with the camera
FREE_SAMPLES = ("samples_per_frame", "target_error")  # with the samples


def settings_rows(app: App, names: tuple[str, ...]) -> None:
    """Draw the settings of these names."""
    controls, opened = tuple(SETTINGS[n] for n in names), app.session.opened.settings
    edit(app, edited_fields(controls, dict(app.session.settings), opened=opened))


def edit(app: App, changes: dict[str, Any]) -> None:
    """Edit settings; edits of the same ones that follow each other are one step of undo."""
    if changes:
        app.session.edit(gesture=f"{list(changes)}", **changes)


def preferences_rows(app: App, controls: list[Control]) -> None:
    """Draw preferences of the window."""
    changes = edited_fields(tuple(controls), dict(app.preferences), "preference")
    if changes:
        with app.messages.reporting():
            app.prefer(replaced(app.preferences, **changes))
