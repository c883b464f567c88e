"""Section of the panel for intensities of light groups and colours of lamps."""

from functools import partial

from imgui_bundle import imgui

from glrt.core.memo import kept_for_the_same
from glrt.plan.methods import traits_of
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.light import Light
from glrt.scene.scene import Scene, with_lights
from glrt.view.app import App
from glrt.view.controls import controls_of
from glrt.view.edits.scene_edits import with_material
from glrt.view.state.costs import cost_of_tint, dimmable_lights, intensity_control
from glrt.view.widgets.fields import edited

EMISSION = next(c for c in controls_of(Light) if c.name == "emission")
_NO_ROOM = (
    "At this size the driver has no room to keep the light of each lamp or bounce apart: a change "
    "of light restarts the picture. A smaller picture has room."
)
_MIXED = (
    "Probes hold the light of all lamps and bounces in one: with this method, a change of light "
    "restarts the picture."
)


def draw_lights(app: App) -> None:
    """Draw a slider for each light group, and the colours of its lamps."""
    scene = app.session.scene
    if traits_of(app.session.settings).has_probes:
        imgui.push_text_wrap_pos(0.0)
        imgui.text_disabled(_MIXED)
        imgui.pop_text_wrap_pos()
    elif app.session.lacks_room:
        imgui.push_text_wrap_pos(0.0)
        imgui.text_disabled(_NO_ROOM)
        imgui.pop_text_wrap_pos()
    intensities, lamps = _groups(scene)
    is_one = sum(isinstance(m, Light) for m in scene.materials.values()) == 1
    for group, intensity in intensities.items():
        imgui.separator_text(group)
        row = f"{group} intensity" if len(intensities) > 1 else "intensity"
        _intensity(app, group, intensity, row, group)
        for name in lamps.get(group, ()):
            _emission(app, name, is_one, name)


def draw_lamp(app: App, name: str, group: str) -> None:
    """Draw intensity and colour of one lamp, for the section that edits its object."""
    intensity = app.session.scene.light_groups.get(group)
    if intensity is not None:
        _intensity(app, group, intensity, "intensity", f"{group} of object")
    _emission(app, name, True, f"{name} of object")


def _intensity(app: App, group: str, value: float, row: str, key: str) -> None:
    control = intensity_control(app.session, group, row)
    new = edited(control.back_to(_opened(app.session.opened.scene).get(group)), value, key)
    if new is not None:
        app.edit_scene(f"light {group}", partial(with_lights, intensities={group: new}))


def _emission(app: App, name: str, is_one: bool, key: str) -> None:
    """Draw the emission of a lamp; other materials that emit have it among their values."""
    material = app.session.scene.materials[name]
    if not isinstance(material, Light):
        return
    row = EMISSION if is_one else EMISSION.named(f"{name} emission")
    before = app.session.opened.scene.materials.get(name)
    row = row.back_to(before.emission if isinstance(before, Light) else None)
    color = edited(row.costing(cost_of_tint(app.session, name)), material.emission, key)
    if color is not None:
        app.edit_scene(f"emission {name}", partial(with_material, name=name, emission=color))


@kept_for_the_same
def _opened(scene: Scene) -> dict[str, float]:
    """Return the intensity of each light group of the scene as it was opened."""
    return scene.light_groups


@kept_for_the_same
def _groups(scene: Scene) -> tuple[dict[str, float], dict[str, list[str]]]:
    """Return the intensity and the lamps of each light group; a material is in one group only."""
    intensities = dimmable_lights(scene)
    first = {finish.material: finish.group for finish in reversed(scene.finishes) if finish.group}
    lamps: dict[str, list[str]] = {}
    for name, material in scene.materials.items():
        if isinstance(material, Opaque) and material.emits:
            lamps.setdefault(first.get(name) or material.group or name, []).append(name)
    return intensities, lamps
