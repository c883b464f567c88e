"""Nodes of USD materials, as nodes of a network."""

import re
from dataclasses import dataclass
from typing import Any

from pxr import Sdf, Usd, UsdShade

from glrt.scene.model_files.networks.nodes import NamedImage, Numbers, Source
from glrt.scene.model_files.usd.images import Images

# ND_multiply_color3FA, of MaterialX: its category, then types; the last one is the output's
_TYPE = r"(?:boolean|integer|float|color3|color4|vector2|vector3|vector4|surfaceshader)(?:FA|B|I)?"
_MATERIALX = re.compile(rf"ND_(.+?)((?:_{_TYPE})*)(?:_\d+)*$")


@dataclass(frozen=True)
class UsdNode:
    """A shader of a file at a moment."""

    shader: UsdShade.Shader
    images: Images
    time: Usd.TimeCode

    @property
    def path(self) -> str:
        """The path of its prim."""
        return str(self.shader.GetPath())

    @property
    def category(self) -> str:
        """The kind of node, such as `image`; empty if it has no identifier."""
        name = str(self.shader.GetShaderId() or "")
        found = _MATERIALX.match(name)
        return found[1] if found else name

    @property
    def type(self) -> str:
        """The type of its output; empty for nodes that are not of MaterialX."""
        found = _MATERIALX.match(str(self.shader.GetShaderId() or ""))
        return re.sub("FA$|B$|I$", "", found[2].rpartition("_")[2]) if found else ""

    def _producer(self, name: str) -> Usd.Attribute | None:
        given = self.shader.GetInput(name)
        found = given.GetValueProducingAttributes() if given else []
        return found[0] if found else None

    def value(self, name: str) -> float | str | Numbers | None:
        """Return the value of an input, or of the input of a material to which it is connected."""
        attribute = self._producer(name)
        if attribute is None or UsdShade.Output.IsOutput(attribute):
            return None
        return _plain(attribute.Get(self.time))

    def source(self, name: str) -> Source | None:
        """Return the output to which an input is connected."""
        attribute = self._producer(name)
        if attribute is None or not UsdShade.Output.IsOutput(attribute):
            return None
        output = UsdShade.Output(attribute)
        node = UsdNode(UsdShade.Shader(output.GetPrim()), self.images, self.time)
        return Source(node, output.GetBaseName())

    def color_space(self, name: str) -> str:
        """Return the color space of a value, or of a texture."""
        attribute = self._producer(name)
        if attribute is not None and attribute.HasColorSpace():
            return str(attribute.GetColorSpace())
        return str(self.value("sourceColorSpace") or "")

    def image(self, kind: str) -> NamedImage | None:
        """Return the image of a texture."""
        return self.images.of_input(self.shader.GetInput("file"), kind)


def _plain(given: Any) -> float | str | Numbers | None:
    """Return a value as Python has it; None for matrices, arrays and things of other kinds."""
    if given is None or isinstance(given, str | Sdf.AssetPath):
        return given if isinstance(given, str) else None
    if isinstance(given, bool | int | float):
        return float(given)
    try:
        return tuple(float(each) for each in given)
    except (TypeError, ValueError):
        return None
