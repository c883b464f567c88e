"""Controls are read from the models; nothing about a value stands twice."""

from typing import get_args

import pytest

from glrt.core.errors import UsageError
from glrt.phong import Phong
from glrt.scene.camera import Camera
from glrt.scene.lights.background import Background
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.light import Light
from glrt.scene.materials.metal import Metal
from glrt.scene.scene import Scene
from glrt.scene.shapes.sphere import Sphere
from glrt.settings import EFFECTS, Cost, Method, Settings
from glrt.view.controls import Control, control_of_items, controls_of, replaced
from glrt.view.state.preferences import Preferences
from glrt.view.widgets.explanations import EFFECT_TEXTS


def of(model: type, name: str) -> Control:
    return next(control for control in controls_of(model) if control.name == name)


def test_a_control_repeats_what_the_model_says() -> None:
    bounces = of(Settings, "bounces")
    assert (bounces.kind, bounces.low, bounces.high) == ("integer", 0, 1000)
    assert bounces.cost is Cost.RESTART
    assert bounces.help == Settings.model_fields["bounces"].description
    exposure = of(Settings, "exposure")
    assert (exposure.kind, exposure.unit, exposure.cost) == ("number", "EV", Cost.FREE)
    method = of(Settings, "method")
    assert (method.choices, method.cost) == (get_args(Method), Cost.RECOMPILE)


def test_every_setting_has_a_control_but_views_and_a_table_whose_keys_have_some() -> None:
    single = {n for n, f in Settings.model_fields.items() if len(get_args(f.annotation)) == 1}
    names = {control.name for control in controls_of(Settings)}
    assert names == set(Settings.model_fields) - {"crop", "aov", "phong", "effects"} - single
    assert tuple(EFFECT_TEXTS) == EFFECTS  # which have a switch each
    assert {control.name for control in controls_of(Phong)} == set(Phong.model_fields)


def test_optional_and_annotated_types_are_seen_through() -> None:
    focus = of(Camera, "focus_distance")
    assert (focus.kind, focus.low) == ("number", 1e-15)
    assert of(Background, "top").kind == "color"
    assert (of(Lambertian, "color").high, of(Light, "emission").high) == (1, 1e15)
    assert of(Sphere, "center").kind == "vector"
    assert {c.name for c in controls_of(Sphere)} == {"priority", "hidden", "center", "radius"}


def test_controls_whose_first_use_compiles_say_so() -> None:
    assert of(Camera, "defocus_angle").cost is Cost.RECOMPILE
    assert of(Metal, "roughness").cost is Cost.RECOMPILE
    assert of(Dielectric, "ior").cost is Cost.RESTART


def test_the_values_of_a_table_have_one_control() -> None:
    intensity = control_of_items(Scene, "lights")
    assert (intensity.kind, intensity.low, intensity.high) == ("number", 0, 1e15)
    assert intensity.named("lamp").name == "lamp"


@pytest.mark.parametrize("model", [Settings, Camera, Metal, Light, Dielectric, Preferences])
def test_every_slider_lies_within_the_valid_range(model: type) -> None:
    for control in controls_of(model):
        assert control.help
        if control.slider:
            low, high = control.slider
            assert low < high
            assert control.low is None or low >= control.low
            assert control.high is None or high <= control.high


def test_wide_ranges_are_logarithmic() -> None:
    assert of(Settings, "samples").is_logarithmic
    assert not of(Settings, "bounces").is_logarithmic


def test_replaced_values_are_checked() -> None:
    camera = Camera(position=(0, 0, 1), look_at=(0, 0, 0))
    assert replaced(camera, fov=30.0).fov == 30
    with pytest.raises(UsageError, match="fov"):
        replaced(camera, fov=180.0)
    with pytest.raises(UsageError, match="same point"):
        replaced(camera, look_at=(0.0, 0.0, 1.0))
