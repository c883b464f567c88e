"""Inputs of a surface, as values of a principled material."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from glrt.scene.model_files.conversion.reports import LeftOut
from glrt.scene.model_files.networks.evaluation import (
    LINEAR,
    SRGB,
    Evaluation,
    Found,
    Picture,
    VertexColors,
)
from glrt.scene.model_files.networks.nodes import Node, Numbers, Table

Defaults = Mapping[str, float | Numbers]  # of the inputs of a surface

BRIGHTEST = 1e9  # radiance

_NEAR = 1e-4  # how far out of its range a value may be by rounding
_STRONGEST = 100.0  # strength of normals


def short(value: float) -> float:
    """Return the decimal number with the fewest digits that is the same in float32."""
    return float(str(np.float32(value)))


@dataclass
class Inputs:
    """The inputs of a surface, with defaults for inputs that a file does not give."""

    node: Node
    evaluation: Evaluation
    defaults: Defaults
    colors: str | None = None  # the name of the colors of vertices that the surface has

    def found(self, name: str) -> Found:
        """Return a number, a color, or a texture."""
        found = self.evaluation.input(self.node, name, name)
        return self._usual(name) if found is None else found

    def _usual(self, name: str) -> Numbers:
        usual = self.defaults[name]
        return usual if isinstance(usual, tuple) else (usual,)

    def number(self, name: str, most: float = 1.0, least: float = 0.0) -> float:
        """Return a number without a texture; it is reported, and the default is taken, if it is."""
        found = self.found(name)
        if not isinstance(found, tuple):
            self.left.add(f"textures of {name}")
            found = self._usual(name)
        return self.within(found[:1], name, most, least)[0]

    def three(self, name: str, most: float = 1.0) -> Numbers:
        """Return a color without a texture, as by `number`."""
        found = self.found(name)
        if not isinstance(found, tuple):
            self.left.add(f"textures of {name}")
            found = self._usual(name)
        return self.within(_three(found), name, most)

    def has(self, name: str) -> bool:
        """Return whether an input has another value than its default."""
        return self.found(name) != self._usual(name)

    def report(self, *names: str) -> None:
        """Report inputs that no material of glrt has, where they have other values than usual."""
        for name in names:
            if self.has(name):
                self.left.add(name)

    def report_vectors(self, *names: str) -> None:
        """Report normals and tangents that no material of glrt has, where nodes give them."""
        for name in names:
            if self.node.source(name) is not None:
                self.left.add(name)

    @property
    def left(self) -> LeftOut:
        """Where parts of the file that are left out are reported."""
        return self.evaluation.left

    def color_key(self, found: Found, name: str, most: float = 1.0) -> list[float] | Table:
        """Return a color of a material, or its texture."""
        if isinstance(found, VertexColors):
            if self.colors is None and most == 1.0:
                self.colors = found.name
                return [1.0, 1.0, 1.0]
            self.left.add(f"colors of vertices of {name}")
            found = self._usual(name)
        if not isinstance(found, Picture):
            return list(self.within(_three(found), name, most))
        if found.space in LINEAR:
            self.left.add(f"the color space {found.space} of images of {name}")
        if any(found.bias[:3]):
            self.left.add(f"bias of textures of {name}")
        return {**found.table, "factor": list(self.within(found.factor[:3], name, most))}

    def number_key(self, found: Found, name: str) -> float | Table:
        """Return a number of a material from 0 to 1, or its texture."""
        if isinstance(found, VertexColors):
            self.left.add(f"colors of vertices of {name}")
            found = self._usual(name)
        if not isinstance(found, Picture):
            return self.within((found or (0.0,))[:1], name)[0]
        one = found.channel(0)
        if one.space in SRGB:
            self.left.add(f"the color space {one.space} of images of {name}")
        if one.bias["rgba".index(one.table["channel"])]:
            self.left.add(f"bias of textures of {name}")
        return {**one.table, "factor": self.within(one.factor[:1], name)[0]}

    def normal_key(self, name: str, strength: float = 1.0) -> Table | None:
        """Return the texture of normals; None for none."""
        found = self.evaluation.input(self.node, name, name)
        if not isinstance(found, Picture):
            return None
        table = {key: value for key, value in found.table.items() if key != "channel"}
        strength *= found.strength
        if not found.is_normal:  # of UsdUVTexture: codes become normals by its scale and bias
            half = found.factor[0] / 2
            usual = [2 * half, 2 * half, 2.0], [-half, -half, -1.0]
            pairs = zip((*found.factor[:3], *found.bias[:3]), usual[0] + usual[1], strict=True)
            if all(abs(a - b) <= _NEAR for a, b in pairs):
                strength *= half
            else:
                self.left.add("scale and bias of normals other than 2 and -1")
        return {**table, "strength": min(max(strength, 0.0), _STRONGEST)}

    def within(
        self, values: Sequence[float], name: str, most: float = 1.0, least: float = 0.0
    ) -> Numbers:
        """Return numbers moved into a range; a change beyond rounding is reported."""
        given = tuple(short(value) for value in values)
        if not all(math.isfinite(value) for value in given):
            self.left.add(f"{name} that is no number")
            return tuple(least for _ in given)
        found = tuple(min(max(value, least), most) for value in given)
        if max(abs(a - b) for a, b in zip(given, found, strict=True)) > _NEAR:
            self.left.add(f"the part of {name} outside {least:g} to {most:g}")
        return found


def _three(found: Numbers | None) -> Numbers:
    values = found or (0.0,)
    return values[:3] if len(values) > 2 else values[:1] * 3
