"""Lights of a USD file, as tables of a scene.

Radiance is intensity times 2^exposure times color, as UsdLux has it
(https://openusd.org/release/user_guides/schemas/usdLux/LightAPI.html).
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pxr import Usd, UsdLux

from glrt.scene.model_files.conversion.reports import LeftOut
from glrt.scene.model_files.networks.inputs import short
from glrt.scene.model_files.networks.nodes import Table
from glrt.scene.model_files.usd.images import Images

Matrix = NDArray[np.float64]
Vector = NDArray[np.float64]

_UNEVEN = 1e-3  # share by which a light is stretched
_LEAST_ANGLE, _MOST_ANGLE = 1e-3, 90.0  # degrees of a sun


class Lamps:
    """Lights as tables of a scene: materials, objects, suns and a background."""

    def __init__(self, left: LeftOut, images: Images, time: Usd.TimeCode) -> None:
        self._left, self._images, self._time = left, images, time
        self.tables: Table = {"materials": {}, "objects": [], "suns": []}

    def add(self, prim: Usd.Prim, matrix: Matrix, unit: float) -> None:
        """Add a light; `matrix` leads to the scene, whose unit is 1 / `unit` of the file's."""
        kinds = {
            "DistantLight": self._distant,
            "SphereLight": self._sphere,
            "RectLight": self._rect,
            "DiskLight": self._disk,
            "CylinderLight": self._cylinder,
            "DomeLight": self._dome,
        }
        kind = prim.GetTypeName()
        if kind not in kinds:
            self._left.add("lights of meshes (MeshLightAPI)" if kind == "Mesh" else kind)
            return
        if not np.isfinite(matrix).all():
            self._left.add("lights placed beyond all numbers")
            return
        self._note(prim)
        kinds[kind](prim, matrix, unit)

    def _value(self, prim: Usd.Prim, name: str, default: Any) -> Any:
        attribute = prim.GetAttribute(f"inputs:{name}")
        found = attribute.Get(self._time) if attribute else None
        return default if found is None else found

    def _note(self, prim: Usd.Prim) -> None:
        """Report what lamps of a scene do not have."""
        for name, usual in (("diffuse", 1.0), ("specular", 1.0), ("shadow:enable", True)):
            if self._value(prim, name, usual) != usual:
                self._left.add(f"{name} of lights")
        for name in ("shaping:focus", "shaping:ies:file"):
            if self._value(prim, name, None):
                self._left.add(f"{name} of lights")
        if prim.GetTypeName() != "DomeLight" and self._value(prim, "texture:file", None):
            self._left.add("textures of lights")
        if UsdLux.LightAPI(prim).GetFiltersRel().GetTargets():
            self._left.add("filters of lights")

    def _radiance(self, prim: Usd.Prim, size: float = 1.0) -> list[float]:
        """Return the radiance; `size` divides it where the light is normalized."""
        usual = 50000.0 if prim.GetTypeName() == "DistantLight" else 1.0
        scale = float(self._value(prim, "intensity", usual))
        scale *= 2.0 ** min(float(self._value(prim, "exposure", 0.0)), 200.0)
        if self._value(prim, "normalize", False):
            scale /= size
        color = np.array(self._value(prim, "color", (1, 1, 1)), np.float64)
        if self._value(prim, "enableColorTemperature", False):
            kelvin = float(self._value(prim, "colorTemperature", 6500.0))
            color *= np.array(UsdLux.BlackbodyTemperatureAsRgb(kelvin))
        found = scale * color
        if not np.isfinite(found).all() or (found < 0).any():
            self._left.add("light of less than nothing")
            found = np.nan_to_num(found, nan=0, posinf=0).clip(0)
        return [short(it) for it in found]

    def _put(self, prim: Usd.Prim, matrix: Matrix, shape: Table, area: float) -> None:
        """Add the object and the material of a lamp of an area in units of the file."""
        if not 0 < area < math.inf:
            self._left.add("lights of no size")
            return
        name = f"light {prim.GetName()}"
        while name in self.tables["materials"]:
            name += "'"
        material: Table = {"type": "light", "emission": self._radiance(prim, area)}
        angle = float(self._value(prim, "shaping:cone:angle", 90.0))
        if UsdLux.ShapingAPI(prim).GetShapingConeAngleAttr().HasAuthoredValue() and angle < 90:
            softness = min(max(float(self._value(prim, "shaping:cone:softness", 0.0)), 0.0), 1.0)
            axis = list(map(float, -matrix[:3, 2]))
            outer = max(angle, 0.1)
            material["cone"] = {"axis": axis, "inner": outer * (1 - softness), "outer": outer}
        self.tables["materials"][name] = material
        self.tables["objects"].append({**shape, "material": name, "name": name})

    def _scale(self, matrix: Matrix) -> float:
        """Return by how much a matrix enlarges: the mean where it does so unevenly."""
        lengths = np.linalg.norm(matrix[:3, :3], axis=0)
        if np.ptp(lengths) > _UNEVEN * lengths.max():
            self._left.add("uneven scales of round lights")
        return float(lengths.mean())

    def _distant(self, prim: Usd.Prim, matrix: Matrix, unit: float) -> None:
        angle = float(self._value(prim, "angle", 0.53))
        share = math.pi * math.sin(math.radians(min(max(angle, 0.0), 180.0)) / 2) ** 2 or 1.0
        irradiance = [share * it for it in self._radiance(prim, share)]
        towards = matrix[:3, 2]
        length = float(np.linalg.norm(towards))
        if not length > 0:
            self._left.add("lights of no size")
            return
        shown = min(max(angle, _LEAST_ANGLE), _MOST_ANGLE)
        sun = {"direction": list(map(float, towards / length)), "irradiance": irradiance}
        self.tables["suns"].append({**sun, "angle": shown})

    def _sphere(self, prim: Usd.Prim, matrix: Matrix, unit: float) -> None:
        radius = float(self._value(prim, "radius", 0.5)) * self._scale(matrix)
        shape = {"shape": "sphere", "center": list(map(float, matrix[:3, 3])), "radius": radius}
        self._put(prim, matrix, shape, 4 * math.pi * (radius * unit) ** 2)

    def _rect(self, prim: Usd.Prim, matrix: Matrix, unit: float) -> None:
        width, height = (float(self._value(prim, key, 1.0)) for key in ("width", "height"))
        along, up = width * matrix[:3, 0], height * matrix[:3, 1]
        normal = np.cross(along, up)
        area = float(np.linalg.norm(normal)) * unit**2
        if normal @ matrix[:3, 2] > 0:  # it shines along -z
            along = -along
        corner = matrix[:3, 3] - along / 2 - up / 2
        table = {"corner": corner, "edge_u": along, "edge_v": up}
        shape = {"shape": "quad", **{key: list(map(float, it)) for key, it in table.items()}}
        self._put(prim, matrix, {**shape, "emission_side": "front"}, area)

    def _disk(self, prim: Usd.Prim, matrix: Matrix, unit: float) -> None:
        radius = float(self._value(prim, "radius", 0.5)) * self._scale(matrix)
        shape = {"shape": "disk", "center": list(map(float, matrix[:3, 3])), "radius": radius}
        shape["normal"] = list(map(float, -matrix[:3, 2]))
        area = math.pi * (radius * unit) ** 2
        self._put(prim, matrix, {**shape, "emission_side": "front"}, area)

    def _cylinder(self, prim: Usd.Prim, matrix: Matrix, unit: float) -> None:
        scale = self._scale(matrix)
        radius = float(self._value(prim, "radius", 0.5)) * scale
        arm = float(self._value(prim, "length", 1.0)) / 2 * matrix[:3, 0]
        ends = (list(map(float, matrix[:3, 3] + side * arm)) for side in (-1, 1))
        shape = {"shape": "cylinder", **dict(zip(("from", "to"), ends, strict=True))}
        area = math.tau * radius * 2 * float(np.linalg.norm(arm)) * unit**2
        self._put(prim, matrix, {**shape, "radius": radius, "capped": False}, area)

    def _dome(self, prim: Usd.Prim, matrix: Matrix, unit: float) -> None:
        if "background" in self.tables:
            self._left.add("dome lights but the first")
            return
        found: Table = {"color": self._radiance(prim)}
        path = self._images.path_of(prim.GetAttribute("inputs:texture:file"))
        kind = self._value(prim, "texture:format", "automatic")
        if path and kind not in ("automatic", "latlong"):
            self._left.add(f"images of dome lights as {kind}")
        elif path and (image := self._images.added(path)) is not None:
            found["image"] = image
            middle = matrix[:3, 2] / np.linalg.norm(matrix[:3, 2])  # of the image, its own +z
            found["rotation"] = math.degrees(math.atan2(-middle[0], -middle[2]))
            up = matrix[:3, 1] / np.linalg.norm(matrix[:3, 1])
            if up[1] < 1 - _UNEVEN:
                self._left.add("the tilt of dome lights")
        self.tables["background"] = found
