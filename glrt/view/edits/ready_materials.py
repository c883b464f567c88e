"""Ready-made materials of the window: common metals, glasses, plastics, paints and paper.

Indices of refraction are those of the sodium line, 589 nm, at room temperature: water 1.333, ice
1.309, crown glass 1.523, acrylic 1.491, sapphire 1.768, diamond 2.417 (Born and Wolf, "Principles
of Optics"; Hecht, "Optics"). Roughness and colours of the others are chosen by eye.
"""

from typing import Any

from glrt.scene.materials.conductors import PRESETS
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.metal import Metal
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene
from glrt.view.edits.scene_edits import with_retyped

_INDICES = {
    "water": 1.333,
    "ice": 1.309,
    "crown glass": 1.523,
    "acrylic": 1.491,
    "sapphire": 1.768,
    "diamond": 2.417,
}
_PAINT: dict[str, Any] = {"metallic": 0.7, "roughness": 0.35, "clearcoat": 1.0}
READY: dict[str, Material] = {
    **{name: Metal.model_validate({"preset": name, "roughness": 0.0}) for name in PRESETS},
    "brushed aluminium": Metal(preset="aluminium", roughness=0.3, anisotropy=0.6),
    **{name: Dielectric(ior=ior) for name, ior in _INDICES.items()},
    "frosted glass": Dielectric(ior=_INDICES["crown glass"], roughness=0.4),
    "window pane": Dielectric(ior=_INDICES["crown glass"], thin=True),
    "glossy plastic": Principled(color=(0.7, 0.05, 0.05), roughness=0.08),
    "satin plastic": Principled(color=(0.1, 0.25, 0.6), roughness=0.35),
    "rubber": Principled(color=(0.03, 0.03, 0.03), roughness=0.75),
    "car paint, red": Principled(color=(0.6, 0.03, 0.03), **_PAINT),
    "car paint, blue": Principled(color=(0.03, 0.1, 0.45), **_PAINT),
    "paper": Principled(
        color=(0.75, 0.73, 0.7),
        specular=0.0,
        diffuse_transmission=0.4,
        diffuse_transmission_color=(0.9, 0.85, 0.75),
    ),
    "leaf": Principled(
        color=(0.08, 0.25, 0.04),
        diffuse_transmission=0.5,
        diffuse_transmission_color=(0.4, 0.7, 0.1),
    ),
    "white wall": Lambertian(color=(0.8, 0.8, 0.8)),
    "grey card": Lambertian(color=(0.18, 0.18, 0.18)),
}


def ready_name(material: Material) -> str:
    """Return the name of the ready-made material that has these values; "" for none."""
    return next((name for name, ready in READY.items() if ready == material), "")


def with_ready(scene: Scene, name: str, ready: str) -> Scene:
    """Return the scene in which a material has the values of a ready-made one."""
    material = READY[ready]
    found = with_retyped(scene, name, material.type)
    return found.model_copy(update={"materials": {**found.materials, name: material}})
