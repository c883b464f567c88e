"""Controls of a picture as rows of a page: name, value, range, and present cost of an edit."""

from typing import Any

from glrt.core.memo import kept_for_the_same
from glrt.notebook.messages import LIGHT
from glrt.settings import Settings
from glrt.view.controls import MEANING, Control, controls_of
from glrt.view.state.costs import bounces_control, dimmable_lights, intensity_control
from glrt.view.state.session import Session

Row = dict[str, Any]  # values of JSON

_lights = kept_for_the_same(dimmable_lights)  # a scene may have thousands of objects
_SAMPLES = next(control for control in controls_of(Settings) if control.name == "samples")


def rows_of(session: Session) -> list[Row]:
    """Return a row for bounces, samples, and the intensity of each light group."""
    settings, lights = session.settings, _lights(session.scene)
    return [
        _row("bounces", bounces_control(session), settings.bounces),
        _row("samples", _SAMPLES, settings.samples),
        *(
            _row(f"{LIGHT}{group}", intensity_control(session, group, group), intensity)
            for group, intensity in lights.items()
        ),
    ]


def _row(key: str, control: Control, value: float) -> Row:
    assert control.slider
    low, high = control.slider
    return {
        "key": key,
        "label": control.label if key == control.name else control.name,
        "value": value,
        "low": min(low, value),
        "high": max(high, value),
        "whole": control.kind == "integer",
        "logarithmic": control.is_logarithmic,
        "help": control.help,
        "costs": [
            {"cost": cost.value, "where": where, "meaning": MEANING[cost]}
            for cost, where in control.costs
        ],
    }
