"""Values that nodes give: numbers, textures, or colors of vertices."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from glrt.scene.images.codes import decode_srgb
from glrt.scene.model_files.conversion.reports import LeftOut
from glrt.scene.model_files.networks.arithmetic import ONE, TWO, between, of_one, of_two
from glrt.scene.model_files.networks.coordinates import Coordinates
from glrt.scene.model_files.networks.nodes import Node, Numbers, Source, Table

_MOST_NODES = 10_000  # of an input
_DEEPEST = 64  # nodes between a surface and a value
_CHANNELS = {"r": 0, "g": 1, "b": 2, "a": 3, "x": 0, "y": 1, "z": 2, "w": 3}
_WRAPS = {"periodic": "repeat", "repeat": "repeat", "mirror": "mirror", "clamp": "clamp"}
SRGB = ("srgb_texture", "sRGB", "srgb_rec709_scene", "srgb_rec709_display")
LINEAR = ("lin_rec709", "lin_rec709_scene", "raw", "none", "data")
_IMAGES = ("image", "tiledimage", "UsdUVTexture", "gltf_image", "gltf_colorimage", "gltf_normalmap")
_PASSING = ("dot", "convert", "swizzle")
_COLORS = ("UsdPrimvarReader_float3", "UsdPrimvarReader_color3", "geompropvalue", "geomcolor")
_FACTORS = {"UsdUVTexture": "scale", "gltf_image": "factor", "gltf_colorimage": "color"}


@dataclass(frozen=True)
class Picture:
    """A texture: the keys of its table without `factor`, and how its channels are changed."""

    table: Table
    space: str = ""  # of its colors; empty if the file does not say, or it has none
    factor: Numbers = (1.0, 1.0, 1.0, 1.0)  # of its channels
    bias: Numbers = (0.0, 0.0, 0.0, 0.0)
    strength: float = 1.0  # as normals in tangent space
    is_normal: bool = False  # by a node that decodes normals

    def channel(self, index: int) -> "Picture":
        """Return one of its channels, by its place."""
        if "channel" in self.table:
            return self
        table = {**self.table, "channel": "rgba"[index]}
        return replace(self, table=table, factor=(self.factor[index],) * 4)


@dataclass(frozen=True)
class VertexColors:
    """Colors of vertices, by the name of their primvar."""

    name: str


Found = Numbers | Picture | VertexColors | None


@dataclass
class Evaluation:
    """Values of the nodes of a material."""

    coordinates: Coordinates
    left: LeftOut
    _nodes: int = 0
    _known: dict[tuple[str, str, str], Found] = field(default_factory=dict)

    def input(self, node: Node, name: str, kind: str) -> Found:
        """Return what an input of a node has; None for nothing, or for what is left out.

        `kind` is the input of the surface for which it is asked: it stands in reports.
        """
        self._nodes = 0
        return self._input(node, name, kind, 0)

    def _input(self, node: Node, name: str, kind: str, depth: int) -> Found:
        source = node.source(name)
        if source is not None:
            return self._output(source, kind, depth)
        given = node.value(name)
        if given is None or isinstance(given, str):
            return None
        values = given if isinstance(given, tuple) else (float(given),)
        space = node.color_space(name)
        if len(values) > 2 and space in SRGB:
            codes = decode_srgb(np.clip(np.array(values[:3]), 0, 1))
            return (*map(float, codes), *values[3:])
        if len(values) > 2 and space not in (*LINEAR, ""):
            self.left.name(f"the color space of {kind},", space)
        return values

    def _output(self, source: Source, kind: str, depth: int) -> Found:
        key = source.node.path, source.output, kind
        if key not in self._known:
            self._nodes += 1
            if depth > _DEEPEST or self._nodes > _MOST_NODES:
                self.left.add(f"the nodes of {kind}, which are too many")
                return None
            self._known[key] = None  # for a ring
            self._known[key] = self._of_node(source.node, source.output, kind, depth + 1)
        return self._known[key]

    def _of_node(self, node: Node, output: str, kind: str, depth: int) -> Found:
        category = node.category

        def given(name: str) -> Found:
            return self._input(node, name, kind, depth)

        if category in _IMAGES:
            return self._texture(node, output, kind, depth)
        if category == "constant":
            return given("value")
        if category in _PASSING:
            return given("in")
        if category == "normalmap":
            return self._normal(node, kind, depth)
        if category in ("extract", "separate2", "separate3", "separate4"):
            if category == "extract":
                index = node.value("index")
                place = int(index) if isinstance(index, float | int) else 0
            else:
                place = _CHANNELS.get(output.removeprefix("out"), 0)
            return _part(given("in"), place)
        if category in _COLORS:
            return VertexColors(str(node.value("varname") or node.value("geomprop") or ""))
        if category == "mix":
            return self._mix(node, kind, depth)
        if category.startswith("combine"):
            parts = [given(f"in{place}") for place in (1, 2, 3, 4)]
            numbers = [it for it in parts if isinstance(it, tuple)]
            if not any(isinstance(it, Picture) for it in parts):
                return tuple(value for each in numbers for value in each) or None
        if category in TWO:
            found = self._of_two(category, given("in1"), given("in2"))
            if found is not None:
                return found
        if category in (*ONE, "invert", "clamp"):
            found = self._of_one(node, kind, depth)
            if found is not None:
                return found
        return self._unknown(node, kind, depth)

    def _unknown(self, node: Node, kind: str, depth: int) -> Found:
        """Report a node that is not known; return the first texture or number that it takes."""
        self.left.name(f"{kind} by nodes", node.category)
        for name in ("in", "in1", "fg", "bg", "in2"):
            if node.source(name) is not None:
                found = self._input(node, name, kind, depth)
                if found is not None:
                    return found
        return None

    def _of_two(self, category: str, first: Found, second: Found) -> Found:
        """Return what two values give together; None for two textures, and for others."""
        if isinstance(second, Picture) and category == "multiply":
            first, second = second, first
        if isinstance(first, Picture) and isinstance(second, tuple):
            if category == "multiply":
                return times(first, second)
            if category == "divide" and all(second):
                return times(first, tuple(1 / it for it in second))
        if isinstance(first, tuple) and isinstance(second, tuple):
            return of_two(category, first, second)
        return None

    def _of_one(self, node: Node, kind: str, depth: int) -> Found:
        """Return what a number or a color gives; None for textures."""
        given = self._input(node, "in", kind, depth)
        if not isinstance(given, tuple):
            return None
        if node.category == "invert":
            return self._of_two("subtract", self._bound(node, "amount", 1.0, kind, depth), given)
        if node.category == "clamp":
            raised = self._of_two("max", given, self._bound(node, "low", 0.0, kind, depth))
            return self._of_two("min", raised, self._bound(node, "high", 1.0, kind, depth))
        return of_one(node.category, given)

    def _bound(self, node: Node, name: str, usual: float, kind: str, depth: int) -> Found:
        found = self._input(node, name, kind, depth)
        return (usual,) if found is None else found

    def _mix(self, node: Node, kind: str, depth: int) -> Found:
        """Return the mean of two colors by a share; in the middle for a share by a texture."""
        back, front, share = (self._input(node, it, kind, depth) for it in ("bg", "fg", "mix"))
        if isinstance(share, tuple) and len(share) == 1 and share[0] in (0.0, 1.0):
            return front if share[0] else back
        if isinstance(back, tuple) and isinstance(front, tuple):
            if not isinstance(share, tuple):
                self.left.name(f"{kind} by nodes", "mix by a texture, taken as one half")
            return between(back, front, share[0] if isinstance(share, tuple) else 0.5)
        return self._unknown(node, kind, depth)

    def _texture(self, node: Node, output: str, kind: str, depth: int) -> Found:
        image = node.image(kind)
        if image is None:
            name = "fallback" if node.category == "UsdUVTexture" else "default"
            return self._input(node, name, kind, depth)
        lying = self.coordinates.table(node)
        if lying is None:
            self.left.add(f"textures of {kind} by other coordinates, or skewed")
            return None
        has_colors = node.type in ("color3", "color4", "multioutput", "")
        space = node.color_space("file") if has_colors and not image.is_linear else ""
        factor = _FACTORS.get(node.category)
        found = Picture(
            {"image": image.number, **lying, "wrap": self._wraps(node)},
            space=space,
            factor=_four(node.value(factor) if factor else None, 1.0),
            bias=_four(node.value("bias"), 0.0),
            is_normal=node.category == "gltf_normalmap",
        )
        if node.category == "gltf_colorimage" and node.source("geomcolor"):
            self.left.add(f"colors of vertices of {kind}")
        if (channel := output.removeprefix("out")) in _CHANNELS:
            return found.channel(_CHANNELS[channel])
        return found.channel(0) if node.type == "float" else found

    def _wraps(self, node: Node) -> list[str]:
        found = []
        for name, other in (("uaddressmode", "wrapS"), ("vaddressmode", "wrapT")):
            given = str(node.value(name) or node.value(other) or "periodic")
            if given in ("black", "constant"):
                self.left.add("black beyond the edges of textures")
                given = "clamp"
            found.append(_WRAPS.get(given, "repeat"))
        return found

    def _normal(self, node: Node, kind: str, depth: int) -> Found:
        found = self._input(node, "in", kind, depth)
        if not isinstance(found, Picture):
            return None
        strength = node.value("scale")
        if isinstance(strength, tuple):
            strength = strength[0]
        if node.value("space") == "object":
            self.left.add("normals in object space")
            return None
        value = float(strength) if isinstance(strength, float | int) else 1.0
        return replace(found, strength=value, is_normal=True)


def times(found: Found, factor: Numbers) -> Found:
    """Return a value that is multiplied by one or more numbers."""
    if isinstance(found, Picture):
        wide = _four(factor, 1.0)
        return replace(
            found,
            factor=tuple(a * b for a, b in zip(found.factor, wide, strict=True)),
            bias=tuple(a * b for a, b in zip(found.bias, wide, strict=True)),
        )
    if isinstance(found, tuple):
        return of_two("multiply", found, factor)
    return found


def _part(found: Found, place: int) -> Found:
    if isinstance(found, Picture):
        return found.channel(min(max(place, 0), 3))
    if isinstance(found, tuple) and found:
        return (found[min(max(place, 0), len(found) - 1)],)
    return None


def _four(given: Any, usual: float) -> Numbers:
    """Return four numbers: of one number four times it, and what is missing is `usual`."""
    if given is None or isinstance(given, str):
        return (usual,) * 4
    values = given if isinstance(given, tuple) else (float(given),)
    if len(values) == 1:
        return values * 4
    return (*values, *(usual,) * (4 - len(values)))
