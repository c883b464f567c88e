"""UsdPreviewSurface materials, as tables of principled materials of a scene.

https://openusd.org/release/spec_usdpreviewsurface.html
"""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from pxr import UsdShade

from glrt.scene.model_files.usd.reports import LeftOut
from glrt.scene.model_files.usd.texture_tables import Table, Textures, producer

COLORS = "displayColor"  # the primvar of colors of vertices, and the name of their material
_SURFACE = "UsdPreviewSurface"
_READER = "UsdPrimvarReader_float3"  # of colors of vertices
_NEAR = 1e-4
_BRIGHTEST = 1e9  # radiance
_LARGEST_F0 = 0.99  # of an index of refraction of 399
_DEFAULTS = {
    "metallic": ("metallic", 0.0),
    "roughness": ("roughness", 0.5),
    "clearcoat": ("clearcoat", 0.0),
    "clearcoat_roughness": ("clearcoatRoughness", 0.01),
}
_WITHOUT_TEXTURE = ("clearcoat", "clearcoat_roughness")


@dataclass
class UsdLook:
    """A material: a table of a scene, and which primvars its meshes must have."""

    name: str
    table: Table
    sets: list[str] = field(default_factory=list)  # of texture coordinates, two at most
    colors: str | None = None  # of vertices
    is_two_sided: bool = False  # whether a mesh of it is


def display_look() -> UsdLook:
    """Return the look of meshes that have colors of vertices, and no material."""
    table = {"type": "principled", "color": [1.0, 1.0, 1.0], "roughness": 0.5}
    return UsdLook(COLORS, table, colors=COLORS)


def short(value: float) -> float:
    """Return the decimal number with the fewest digits that is the same in float32."""
    return float(str(np.float32(value)))


class Looks:
    """The materials of a file by their paths, each read once."""

    def __init__(self, textures: Textures, left: LeftOut) -> None:
        self._textures, self._left = textures, left
        self._numbers: dict[str, int | None] = {}
        self._plain: int | None = None
        self.found: list[UsdLook] = []

    def number(self, material: UsdShade.Material | None, has_colors: bool) -> int | None:
        """Return the number of a material among those found.

        Without a material that can be read, it is that of colors of vertices, if there are any.
        """
        path = str(material.GetPath()) if material else ""
        if path not in self._numbers:
            look = self._look(material) if material else None
            self._numbers[path] = self._added(look) if look else None
        if self._numbers[path] is not None or not has_colors:
            return self._numbers[path]
        if self._plain is None:
            self._plain = self._added(display_look())
        return self._plain

    def _added(self, look: UsdLook) -> int:
        self.found.append(look)
        return len(self.found) - 1

    def _look(self, material: UsdShade.Material) -> UsdLook | None:
        shader = material.ComputeSurfaceSource()[0]
        if not shader:
            is_materialx = bool(material.ComputeSurfaceSource("mtlx")[0])
            self._left.add("MaterialX networks" if is_materialx else "materials without a surface")
            return None
        if shader.GetShaderId() != _SURFACE:
            self._left.name("materials of", str(shader.GetShaderId() or "code"))
            return None
        look = UsdLook(material.GetPrim().GetName(), {"type": "principled"})
        _Reading(look, shader, self._textures, self._left).fill()
        if material.GetDisplacementOutput().HasConnectedSource():
            value = self._textures.value(shader, "displacement", 0.0)
            if value or producer(shader.GetInput("displacement")):
                self._left.add("displacement")
        return look


@dataclass
class _Reading:
    look: UsdLook
    shader: UsdShade.Shader
    textures: Textures
    left: LeftOut

    def fill(self) -> None:
        """Fill the table of the look from the inputs of the surface."""
        table = self.look.table
        table["color"] = self._color("diffuseColor", (0.18, 0.18, 0.18), 1.0)
        for key, (name, default) in _DEFAULTS.items():
            table[key] = self._number(name, default, key not in _WITHOUT_TEXTURE)
        table["ior"] = min(max(short(self._plain("ior", 1.5)), 1.0), 1e3)
        if self._plain("useSpecularWorkflow", 0):
            self._specular()
        self._emission()
        self._opacity()
        self._normal()

    def _plain(self, name: str, default: Any) -> Any:
        if producer(self.shader.GetInput(name)):
            self.left.add(f"textures of {name}")
            return default
        return self.textures.value(self.shader, name, default)

    def _color(self, name: str, default: Any, most: float) -> Any:
        """Return a color, or the table of a texture."""
        source = producer(self.shader.GetInput(name))
        if source is None:
            return self._within(self.textures.value(self.shader, name, default), name, most)
        reader = UsdShade.Shader(source.GetPrim())
        if name == "diffuseColor" and reader.GetShaderId() == _READER:
            self.look.colors = str(self.textures.value(reader, "varname", "")) or COLORS
            return [1.0, 1.0, 1.0]
        found = self.textures.table(source, self.look.sets, name, True)
        if found is None:
            return self._within(self._fallback(source, default), name, most)
        scale, bias = self.textures.scale_and_bias(source)
        if any(bias[:3]):
            self.left.add(f"bias of textures of {name}")
        return {**found, "factor": self._within(scale[:3], name, most)}

    def _fallback(self, source: UsdShade.Output, default: Any) -> Any:
        shader = UsdShade.Shader(source.GetPrim())
        given = self.textures.value(shader, "fallback")
        return default if given is None or len(given) < 3 else given[:3]

    def _number(self, name: str, default: float, may_be_texture: bool = True) -> Any:
        """Return a number from 0 to 1, or the table of a texture."""
        source = producer(self.shader.GetInput(name)) if may_be_texture else None
        if source is None:
            (found,) = self._within([self._plain(name, default)], name, 1.0)
            return found
        table = self.textures.table(source, self.look.sets, name, False)
        if table is None:
            return default
        scale, bias = self.textures.scale_and_bias(source)
        place = "rgba".index(table["channel"])
        if bias[place]:
            self.left.add(f"bias of textures of {name}")
        (factor,) = self._within([scale[place]], name, 1.0)
        return {**table, "factor": factor}

    def _within(self, values: Any, name: str, most: float) -> list[float]:
        given = [short(value) for value in values]
        if not all(math.isfinite(value) for value in given):
            self.left.add(f"{name} that is no number")
            return [0.0 for _ in given]
        found = [min(max(value, 0.0), most) for value in given]
        if max(abs(a - b) for a, b in zip(given, found, strict=True)) > _NEAR:
            self.left.add(f"the part of {name} outside 0 to {most:g}")
        return found

    def _specular(self) -> None:
        """Take the reflectance head-on from a color in place of ior and metallic."""
        color = self._within(self._plain("specularColor", (0, 0, 0)), "specularColor", _LARGEST_F0)
        table, most = self.look.table, max(color)
        table["metallic"] = 0.0
        if most == 0:
            table["specular"] = 0.0
            return
        root = math.sqrt(most)
        table["ior"] = (1 + root) / (1 - root)
        table["specular_color"] = [each / most for each in color]

    def _emission(self) -> None:
        found = self._color("emissiveColor", (0, 0, 0), _BRIGHTEST)
        if isinstance(found, dict) or any(found):
            self.look.table["emission"] = found

    def _opacity(self) -> None:
        table = self.look.table
        alpha = self._number("opacity", 1.0)
        if alpha == 1.0:
            return
        if "emission" in table and not isinstance(table["emission"], dict):
            self.left.add("opacity of what emits")
            return
        table["alpha"] = alpha
        cutoff = short(self._plain("opacityThreshold", 0.0))
        if cutoff > 0:
            table["alpha_cutoff"] = min(cutoff, 1.0)

    def _normal(self) -> None:
        source = producer(self.shader.GetInput("normal"))
        if source is None:
            return
        table = self.textures.table(source, self.look.sets, "normal", False)
        if table is None:
            return
        table.pop("channel", None)
        scale, bias = self.textures.scale_and_bias(source)
        strength = scale[0] / 2
        usual = [2 * strength, 2 * strength, 2.0], [-strength, -strength, -1.0]
        pairs = zip(scale[:3] + bias[:3], usual[0] + usual[1], strict=True)
        if not all(abs(a - b) <= _NEAR for a, b in pairs):
            self.left.add("scale and bias of normals other than 2 and -1")
            strength = 1.0
        self.look.table["normal"] = {**table, "strength": min(max(strength, 0.0), 100.0)}
