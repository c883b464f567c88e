"""How textures lie: from the coordinates of a mesh to a place in an image, both with v upwards."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.model_files.networks.nodes import Node, Numbers, Source, Table

_MOST_STEPS = 32  # nodes between a texture and its coordinates
_DIGITS = 9  # of numbers of transforms
_SHEAR = 1e-6
_PASSING = ("dot", "convert")
_READERS = ("UsdPrimvarReader_float2", "UsdPrimvarReader_float3", "UsdPrimvarReader_vector2")
_UP = np.array([[1.0, 0, 0], [0, -1, 1], [0, 0, 1]])  # from v downwards to v upwards, and back

Matrix = NDArray[np.float64]  # (3, 3)


class Lying(NamedTuple):
    """A set of coordinates by its name, and the matrix from it to a place in an image."""

    name: str
    matrix: Matrix


@dataclass
class Coordinates:
    """The sets of coordinates of a material: their names in a file, two at most."""

    names: list[str]
    usual: str | None  # the name of the set of textures that name none; None: they have none
    numbered: tuple[str, str]  # the names of sets by their numbers

    def lying(self, texture: Node) -> Lying | None:
        """Return how a texture lies; None if not by a set of coordinates alone."""
        matrix = own_matrix(texture)
        source = texture.source("texcoord") or texture.source("st")
        for _ in range(_MOST_STEPS):
            if source is None:
                return None if self.usual is None else Lying(self.usual, matrix)
            if (name := self._set(source.node)) is not None:
                return Lying(name, matrix)
            step = _step(source.node)
            if step is None:
                return None
            source, inner = step
            matrix = matrix @ inner
        return None

    def _set(self, node: Node) -> str | None:
        if node.category == "texcoord":
            number = node.value("index")
            return self.numbered[1 if number == 1 else 0]
        if node.category in _READERS:
            return str(node.value("varname") or "st")
        if node.category == "geompropvalue":
            return str(node.value("geomprop") or "st")
        return None

    def table(self, texture: Node) -> Table | None:
        """Return the keys `uv`, `scale`, `rotation` and `offset` of a texture.

        The set of its coordinates is added to the names. The result is None for a third one, for
        coordinates by other nodes, and for transforms that skew or are no numbers.
        """
        found = self.lying(texture)
        if found is None or (found.name not in self.names and len(self.names) == 2):
            return None
        transform = _transform(found.matrix)
        if transform is None:
            return None
        if found.name not in self.names:
            self.names.append(found.name)
        return {**transform, "uv": self.names.index(found.name)}


def own_matrix(texture: Node) -> Matrix:
    """Return the matrix of a texture node itself: that of its tiles or its placement."""
    if texture.category == "tiledimage":
        tiles, moved = _pair(texture, "uvtiling", 1.0), _moved(-_pair(texture, "uvoffset", 0.0))
        tile, image = (_pair(texture, f"realworld{it}size", 1.0) for it in ("tile", "image"))
        with np.errstate(divide="ignore", invalid="ignore"):
            return _scaled(tile / image) @ moved @ _scaled(tiles)
    if texture.category.startswith("gltf_"):
        right, up = _pair(texture, "offset", 0.0)
        order = 0.0 if texture.category == "gltf_colorimage" else texture.value("operationorder")
        pivot = _pair(texture, "pivot", (0.0, 1.0))
        turn = -_number(texture, "rotate", 0.0)
        scale = _pair(texture, "scale", 1.0)
        return _placed(pivot, scale, turn, np.array([-right, up]), bool(order))
    return np.eye(3)


def _step(node: Node) -> tuple[Source | None, Matrix] | None:
    """Return what the coordinates of a node come from, and its matrix; None for other nodes."""
    if node.category in _PASSING:
        return node.source("in"), np.eye(3)
    if node.category == "UsdTransform2d":
        turn, scale = -_number(node, "rotation", 0.0), _pair(node, "scale", 1.0)
        moved = _moved(_pair(node, "translation", 0.0))
        return node.source("in"), moved @ _turned(turn) @ _scaled(scale)
    if node.category == "place2d":
        with np.errstate(divide="ignore"):
            scale = 1 / _pair(node, "scale", 1.0)
        turn, offset = _number(node, "rotate", 0.0), _pair(node, "offset", 0.0)
        order = bool(node.value("operationorder"))
        matrix = _placed(_pair(node, "pivot", 0.0), scale, turn, offset, order)
        return node.source("texcoord"), matrix
    first = node.source("in1")
    if first is None or node.source("in2") is not None:
        return None
    if node.category in ("multiply", "divide"):
        factor = _pair(node, "in2", 1.0)
        with np.errstate(divide="ignore"):
            return first, _scaled(factor if node.category == "multiply" else 1 / factor)
    if node.category in ("add", "subtract"):
        way = _pair(node, "in2", 0.0)
        return first, _moved(way if node.category == "add" else -way)
    return None


def _placed(pivot: Matrix, scale: Matrix, turn: float, offset: Matrix, is_reversed: bool) -> Matrix:
    """Return the matrix of place2d of MaterialX; `scale` is what coordinates are multiplied by."""
    steps = [_scaled(scale), _turned(turn), _moved(-offset)]
    if is_reversed:
        steps.reverse()
    first, second, third = steps
    return _moved(pivot) @ third @ second @ first @ _moved(-pivot)


def _transform(matrix: Matrix) -> Table | None:
    """Return a transform of coordinates with v downwards, as images and glTF have them."""
    down = _UP @ matrix @ _UP
    if not np.isfinite(down).all():
        return None
    (a, b, right), (c, d, low), _ = down
    if b == 0 and c == 0:
        width, height, degrees = a, d, 0.0
    else:
        width = math.hypot(a, c)
        if width == 0:
            return None
        degrees = math.degrees(math.atan2(-c, a))
        height = (a * d - b * c) / width
        skew = abs(a * b + c * d) / width
        if skew > _SHEAR * max(width, abs(height)):
            return None
    if np.array_equal(down, np.eye(3)):
        return {}
    numbers = [round(float(it), _DIGITS) for it in (width, height, degrees, right, low)]
    width, height, degrees, right, low = numbers
    return {"scale": [width, height], "rotation": degrees, "offset": [right, low]}


def _number(node: Node, name: str, default: float) -> float:
    given = node.value(name)
    return float(given) if isinstance(given, float | int) else default


def _pair(node: Node, name: str, default: float | Numbers) -> Matrix:
    given = node.value(name)
    if isinstance(given, str) or given is None:
        given = default
    values = given if isinstance(given, tuple) else (given, given)
    return np.array(values[:2], np.float64)


def _scaled(factors: Matrix) -> Matrix:
    return np.diag([*factors, 1.0])


def _moved(way: Matrix) -> Matrix:
    found = np.eye(3)
    found[:2, 2] = way
    return found


def _turned(degrees: float) -> Matrix:
    """Return the matrix that turns clockwise, as rotate2d of MaterialX does."""
    sin, cos = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    return np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1]])
