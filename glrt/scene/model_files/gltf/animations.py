"""Animations of a glTF file: nodes, skins and morph targets at a moment."""

from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from glrt.core.errors import ContentError
from glrt.core.text import unknown
from glrt.scene.animation.interpolation import between, hermite
from glrt.scene.animation.rotations import unit
from glrt.scene.meshes.triangle_meshes import MOST_KEPT, TriangleMesh
from glrt.scene.model_files.gltf.accessors import Floats, floats
from glrt.scene.model_files.gltf.document import Document
from glrt.scene.model_files.gltf.primitives import mesh_of

_WIDTHS = {"translation": 3, "rotation": 4, "scale": 3}
_WEIGHTS = "weights"
_CUBIC = "CUBICSPLINE"
_WAYS = {"LINEAR": "linear", "STEP": "step", _CUBIC: "cubic"}
_TRIPLE = 3  # rows of a key of a cubic spline: tangent before, value, tangent behind


class Channel(NamedTuple):
    """A value of a node over time."""

    node: int
    path: str  # translation, rotation, scale or weights
    times: Floats  # (k,), increasing
    values: Floats  # (k, w), or (k, 3, w) of a cubic spline
    way: str  # linear, step or cubic

    def at(self, moment: float) -> list[float]:
        """Return the value at a moment in seconds; before the first key and after the last: it."""
        return [float(value) for value in self._values_at(moment)]

    def _values_at(self, moment: float) -> Floats:
        if self.way == "cubic":
            return self._on_curve(moment)
        way: Any = self.way
        return between(self.times.tolist(), self.values, moment, way, self.path == "rotation")

    def _on_curve(self, moment: float) -> Floats:
        last = len(self.times) - 1
        key = int(np.searchsorted(self.times, moment, side="right")) - 1
        if key < 0 or key >= last:
            held: Floats = self.values[min(max(key, 0), last), 1]
            return held
        span = self.times[key + 1] - self.times[key]
        ends = self.values[[key, key + 1], 1]
        tangents = span * np.stack([self.values[key, 2], self.values[key + 1, 0]])
        curve = hermite(ends, tangents, float((moment - self.times[key]) / span))
        return unit(curve) if self.path == "rotation" else curve


class Poses:
    """The mesh of a file at moments of its animations."""

    def __init__(self, document: Document) -> None:
        """Read the keys of all animations; ValueError for keys that do not fit."""
        self._document = document
        self._channels = channels_of(document)
        self._posed = lru_cache(MOST_KEPT)(self._pose)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the animations; their numbers, from 0, where they have none."""
        return tuple(self._channels)

    @property
    def usual(self) -> str:
        """The animation to show if none is named: the first that moves."""
        return next((name for name in self._channels if self.seconds(name)), self.names[0])

    def seconds(self, name: str) -> float:
        """Return the time of the last key of an animation."""
        return seconds_of(self._channels[name])

    def at(self, name: str | None, moment: float) -> TriangleMesh:
        """Return the mesh at a moment in seconds of an animation, by default the usual one.

        Raises ValueError for a name that the file lacks, and for data that do not fit.
        """
        name = self.usual if name is None else name
        if name not in self._channels:
            raise ContentError(unknown("animation", name, self.names, "The file has"))
        return self._posed(name, moment)

    def _pose(self, name: str, moment: float) -> TriangleMesh:
        return mesh_of(self._document, self._changes(name, moment)).outward

    def _changes(self, name: str, moment: float) -> Mapping[int, Mapping[str, Any]]:
        """Return the values of nodes that move, by number of the node and by key."""
        return values_at(self._channels[name], moment)


def channels_of(document: Document) -> dict[str, list[Channel]]:
    """Return the channels of each animation, by its name or its number from 0.

    Raises ValueError for keys that do not fit.
    """
    found = dict[str, list[Channel]]()
    for number, given in enumerate(document.items("animations")):
        here = f"animations[{number}]"
        table = document.table(given, here)
        name = table.get("name")
        usable = isinstance(name, str) and name.isprintable() and name not in found
        found[name if usable and name else str(number)] = _channels(document, table, here)
    return found


def seconds_of(channels: Iterable[Channel]) -> float:
    """Return the time of the last key of some channels; 0 without any."""
    return max((float(channel.times[-1]) for channel in channels), default=0.0)


def values_at(channels: Iterable[Channel], moment: float) -> dict[int, dict[str, Any]]:
    """Return the values of nodes at a moment, by number of the node and by key."""
    found = dict[int, dict[str, Any]]()
    for channel in channels:
        found.setdefault(channel.node, {})[channel.path] = channel.at(moment)
    return found


def _channels(document: Document, animation: dict[str, Any], here: str) -> list[Channel]:
    samplers = document.list(animation.get("samplers"), f"{here}.samplers")
    found = list[Channel]()
    for place, given in enumerate(document.list(animation.get("channels"), f"{here}.channels")):
        where = f"{here}.channels[{place}]"
        channel = document.table(given, where)
        target = document.table(channel.get("target"), f"{where}.target")
        node, path = target.get("node"), target.get("path")
        if node is None or path not in (*_WIDTHS, _WEIGHTS):
            continue  # of an extension
        document.item("nodes", node, f"{where}.target.node")
        index = channel.get("sampler")
        if type(index) is not int or not 0 <= index < len(samplers):
            raise ContentError(f"{where} names a sampler that there is not")
        at = f"{here}.samplers[{index}]"
        found.append(_channel(document, document.table(samplers[index], at), node, path, at))
    return found


def _channel(
    document: Document, sampler: dict[str, Any], node: int, path: str, here: str
) -> Channel:
    way = sampler.get("interpolation", "LINEAR")
    if way not in _WAYS:
        raise ContentError(f"{here}.interpolation must be LINEAR, STEP or CUBICSPLINE")
    times = floats(document, sampler.get("input"), (1,), f"{here}.input").ravel()
    width = _WIDTHS.get(path, 1)
    rows = floats(document, sampler.get("output"), (width,), f"{here}.output")
    keys = len(times) * (_TRIPLE if way == _CUBIC else 1)
    if not keys or len(rows) % keys or (path != _WEIGHTS and len(rows) != keys):
        raise ContentError(f"{here} has {len(times):,} times and {len(rows):,} values")
    if not (np.isfinite(times).all() and (np.diff(times) > 0).all()):
        raise ContentError(f"{here}.input must be times that grow")
    if not np.isfinite(rows).all():
        raise ContentError(f"{here}.output has a value that is not finite")
    values = rows.reshape(len(times), *((_TRIPLE, -1) if way == _CUBIC else (-1,)))
    return Channel(node, path, times, values, _WAYS[way])
