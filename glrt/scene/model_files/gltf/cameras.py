"""Cameras of a glTF file: their field of view, and where they stand at a moment."""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from glrt.core.errors import ContentError
from glrt.core.text import nearest, quoted, unknown
from glrt.scene.files.named_cameras import CameraView
from glrt.scene.model_files.gltf.animations import Channel, channels_of, seconds_of, values_at
from glrt.scene.model_files.gltf.document import Document, number
from glrt.scene.model_files.gltf.nodes import changed, checked_matrix, matrix_of, placed_nodes

_MOST_LISTED = 20  # nodes in a message
_KIND = "perspective"
_NO_CAMERA = "it has no camera that glrt can see by"
_MOVES = ("translation", "rotation", "scale")

Channels = Mapping[str, list[Channel]]  # by the name of their animation
Chain = tuple[tuple[int, Mapping[str, Any]], ...]  # numbers and tables of nodes, a root first


@dataclass(frozen=True)
class FileCamera:
    """A camera with perspective in a node of a glTF file."""

    here: str  # the camera, in messages
    fov: float  # vertical, degrees
    aspect: float | None  # width over height
    chain: Chain  # of the nodes above it and its own
    channels: Channels  # of all animations of the file

    @property
    def usual(self) -> str | None:
        """The first animation that moves the camera; None if none does."""
        return next((name for name in self.channels if self.seconds(name) > 0), None)

    def seconds(self, name: str) -> float:
        """Return the time of the last key by which an animation moves the camera, or 0."""
        return seconds_of(self._moving(name))

    def view(self, animation: str | None = None, moment: float | None = None) -> CameraView:
        """Return where the camera stands, without `moment` in the pose without animation.

        `animation` is by default the usual one. ValueError for an animation that the file lacks,
        and for transforms by which nothing can be seen.
        """
        if animation is not None and animation not in self.channels:
            raise ContentError(unknown("animation", animation, list(self.channels), "The file has"))
        if moment is not None and not self.channels:
            raise ContentError("it has no animation: leave `time` out")
        name = self.usual if animation is None else animation
        is_still = moment is None or name is None
        values = {} if is_still else values_at(self._moving(str(name)), float(moment or 0.0))
        matrix = np.eye(4)
        for index, node in self.chain:
            node = changed(node, values[index]) if index in values else node
            matrix = checked_matrix(matrix @ matrix_of(node, f"nodes[{index}]"), f"nodes[{index}]")
        return CameraView(*self._directions(matrix), self.fov)

    def _directions(self, matrix: Any) -> tuple[Any, Any, Any]:
        """Return place, point looked at and upward direction of a matrix, (3,) each."""
        right_up_back = matrix[:3, :3]
        if abs(np.linalg.det(right_up_back)) == 0:
            raise ContentError(f"{self.here} stands in a node whose transform is flat")
        place, up, back = matrix[:3, 3], right_up_back[:, 1], right_up_back[:, 2]
        return place, place - back / np.linalg.norm(back), up / np.linalg.norm(up)

    def _moving(self, name: str) -> list[Channel]:
        above = {index for index, _ in self.chain}
        return [it for it in self.channels[name] if it.node in above and it.path in _MOVES]


class FileCameras:
    """The cameras of a glTF file, by the names of their nodes."""

    def __init__(self, document: Document) -> None:
        """Read nodes and animations; ValueError for data that do not fit."""
        self._document, self._channels = document, channels_of(document)
        shown = {placed.number: placed.node for placed in placed_nodes(document)}
        self._nodes = {_name(node) for node in shown.values()} - {""}
        self._chains = _by_name(_chains(shown))

    @property
    def names(self) -> list[str]:
        """Names of the nodes whose camera has perspective, as `find` takes them."""
        return list(self._seeing)

    @property
    def first(self) -> tuple[str, FileCamera] | None:
        """The first camera with perspective, and the name that finds it; None without one."""
        return next(((name, self.find(name)) for name in self._seeing), None)

    def find(self, node: str | None) -> FileCamera:
        """Return the camera of a node, or the only one; ValueError lists the nodes with cameras."""
        seeing = self._seeing
        if node is None:
            if len(seeing) != 1:
                has = f"it has {len(seeing)} cameras: choose one by `node`"
                raise ContentError(f"{has if seeing else _NO_CAMERA}.{self._listed}")
            node = seeing[0]
        if node in seeing:
            return self._read(self._chains[node])
        if node in self._chains:
            raise ContentError(
                f"the camera of node {quoted(node)} has no perspective.{self._listed}"
            )
        same = [name for name, chain in self._chains.items() if _name(chain[-1][1]) == node]
        if same:
            raise ContentError(
                f"{len(same)} nodes with a camera are named {quoted(node)}: choose one by its "
                f"number, node = {' or '.join(map(quoted, same))}.{self._listed}"
            )
        if node in self._nodes:
            raise ContentError(f"node {quoted(node)} has no camera.{self._listed}")
        near = nearest(node, tuple(seeing))
        meant = f"; did you mean {quoted(near)}?" if near else "."
        raise ContentError(f"it shows no node {quoted(node)}{meant}{self._listed}")

    @cached_property
    def _seeing(self) -> list[str]:
        """Names of the nodes whose camera has perspective."""
        return [name for name, it in self._chains.items() if self._table(it)["type"] == _KIND]

    @property
    def _listed(self) -> str:
        if not self._seeing:
            return " No node that it shows has a camera with perspective."
        rest = len(self._seeing) - _MOST_LISTED
        more = f" and {rest:,} more" if rest > 0 else ""
        return f" Nodes with a camera: {', '.join(map(quoted, self._seeing[:_MOST_LISTED]))}{more}."

    def _table(self, chain: Chain) -> dict[str, Any]:
        camera = self._document.item("cameras", chain[-1][1]["camera"], f"nodes[{chain[-1][0]}]")
        return {"type": None, **camera}

    def _read(self, chain: Chain) -> FileCamera:
        here = f"cameras[{chain[-1][1]['camera']}]"
        own = self._document.table(self._table(chain).get(_KIND), f"{here}.{_KIND}")
        fov = number(own.get("yfov"), f"{here}.{_KIND}.yfov", 1e-3, 3.1)
        aspect = own.get("aspectRatio")
        if aspect is not None:
            aspect = number(aspect, f"{here}.{_KIND}.aspectRatio", 0.05, 20)
        return FileCamera(here, math.degrees(fov), aspect, chain, self._channels)


def camera_of(document: Document) -> tuple[str, FileCamera] | None:
    """Return the first camera with perspective, and the name of its node; None without one."""
    return FileCameras(document).first if document.items("cameras") else None


def left_out(camera: object, suns: int, document: Document) -> tuple[str, ...]:
    """Return in words which cameras and lights are left out."""
    found = ["cameras without perspective"] if not camera and document.items("cameras") else []
    return (*found, *(["directional lights but the first"] if suns > 1 else []))


def _chains(shown: Mapping[int, Mapping[str, Any]]) -> Iterator[Chain]:
    """Yield each node with a camera behind those above it, of nodes by number."""
    above = {child: index for index, node in shown.items() for child in node.get("children", [])}
    for index, node in shown.items():
        if "camera" in node:
            numbers = [index]
            while numbers[-1] in above:
                numbers.append(above[numbers[-1]])
            yield tuple((at, shown[at]) for at in reversed(numbers))


def _by_name(chains: Iterable[Chain]) -> dict[str, Chain]:
    """Return chains by the name of their last node, or its number if other nodes share the name."""
    ends = [(*chain[-1], chain) for chain in chains]
    count = Counter(_name(node) for _, node, _ in ends)
    return {
        name if (name := _name(node)) and count[name] == 1 else str(index): chain
        for index, node, chain in ends
    }


def _name(node: Mapping[str, Any]) -> str:
    name = node.get("name")
    return name if isinstance(name, str) and name.isprintable() else ""
