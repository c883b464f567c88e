"""Controls explain what they change."""

import pytest

from glrt.phong import Phong
from glrt.scene.materials.metal import Metal
from glrt.view.controls import Control, controls_of
from glrt.view.panels import lights
from glrt.view.state import costs
from glrt.view.tabs.kept import SETTINGS
from glrt.view.tabs.paths import PER_UPDATE
from glrt.view.widgets.explanations import EXPLANATIONS, explanation_of


@pytest.mark.parametrize("name", ["method", "sampler", "roulette", "bounces", "samples"])
def test_controls_of_paths_explain_themselves(name: str) -> None:
    text = explanation_of(SETTINGS[name])
    assert 2 <= text.count(". ") + text.count(": ") + 1 <= 8
    assert len(text) > 100


@pytest.mark.parametrize("control", [costs.INTENSITY, lights.EMISSION])
def test_lamps_explain_themselves_under_any_name(control: Control) -> None:
    for name in ("emission", "intensity"):
        for row in (name, f"blue {name}", f"lamp 2 {name}"):
            assert explanation_of(control.named(row)) == EXPLANATIONS[name]


def test_what_needs_no_explanation_has_none() -> None:
    assert explanation_of(SETTINGS["width"]) == ""


def test_each_explanation_is_of_a_control() -> None:
    named = {*SETTINGS, "intensity", "emission", "ior", PER_UPDATE.name}
    named |= {control.name for model in (Metal, Phong) for control in controls_of(model)}
    assert EXPLANATIONS.keys() <= named
