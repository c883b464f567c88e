"""Convert lights of a glTF file to those of a scene."""

import math
from typing import Any

import numpy as np

from glrt.core.errors import ContentError
from glrt.scene.model_files.gltf.document import Document, number, numbers
from glrt.scene.model_files.gltf.nodes import Placed, placed_nodes

LUMENS = 683.0  # lumens of a watt at the most visible wavelength: candela and lux become W
LIT = "glrt_lit"  # in the extras of a file that glrt exported: its surfaces light the scene
LAMP_SIZE = 0.01  # radius of the sphere of a point light, over the radius of the model


def lights_of(document: Document, size: float) -> dict[str, Any]:
    """Return lights as tables of a scene: materials, objects, suns; `size`: radius of the model.

    A point light of I candela is a sphere of radius r with L = I / (683 pi r^2).
    """
    listed = document.extension(document.json, "KHR_lights_punctual", "the file") or {}
    lights = document.list(listed.get("lights", []), "lights")
    found: dict[str, Any] = {"materials": {}, "objects": [], "suns": []}
    for placed in placed_nodes(document):
        own = document.extension(placed.node, "KHR_lights_punctual", f"nodes[{placed.number}]")
        if own is None:
            continue
        index = own.get("light")
        if type(index) is not int or not 0 <= index < len(lights):
            raise ContentError(f"nodes[{placed.number}] names a light that there is not")
        here = f"lights[{index}]"
        _add(found, document.table(lights[index], here), placed, size, here)
    return found


def is_lit(document: Document) -> bool:
    """Return whether glrt exported a scene with light of its own to the file."""
    extras = document.table(document.json.get("asset", {}), "asset").get("extras")
    return isinstance(extras, dict) and extras.get(LIT) is True


def _add(
    found: dict[str, Any], light: dict[str, Any], placed: Placed, size: float, here: str
) -> None:
    color = numbers(light.get("color", [1, 1, 1]), 3, f"{here}.color", 0)
    intensity = number(light.get("intensity", 1), f"{here}.intensity", 0)
    back, kind = placed.matrix[:3, 2], light.get("type")
    if kind not in ("point", "spot", "directional"):
        raise ContentError(f"{here}.type is none of point, spot and directional")
    if kind != "point" and not np.linalg.norm(back) > 0:
        raise ContentError(f"{here} stands in a node whose transform is flat")
    if kind == "directional":
        watts = tuple(intensity / LUMENS * each for each in color)
        found["suns"].append({"direction": back / np.linalg.norm(back), "irradiance": watts})
        return
    radius = LAMP_SIZE * size
    radiance = intensity / LUMENS / (math.pi * radius**2)
    name = f"light {placed.number}"
    material: dict[str, Any] = {
        "type": "light",
        "emission": tuple(radiance * each for each in color),
    }
    if kind == "spot":
        own = Document.table(light.get("spot", {}), f"{here}.spot")
        inner, outer = own.get("innerConeAngle", 0), own.get("outerConeAngle", math.pi / 4)
        outer = math.degrees(number(outer, f"{here}.spot.outerConeAngle", 1e-3, math.pi / 2))
        inner = math.degrees(number(inner, f"{here}.spot.innerConeAngle", 0, math.pi / 2))
        axis = -back / np.linalg.norm(back)
        cone = {"axis": axis, "inner": min(inner, outer), "outer": outer}
        material["cone"] = cone
    found["materials"][name] = material
    place = placed.matrix[:3, 3]
    sphere = {"shape": "sphere", "center": place, "radius": radius, "material": name}
    found["objects"].append({**sphere, "name": name})
