"""Vertex attributes of a primitive, from accessors or unpacked, with morph targets added."""

from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from glrt.core.errors import ContentError
from glrt.scene.model_files.gltf.accessors import Floats, Ints, floats, indices
from glrt.scene.model_files.gltf.coordinates import name_of, sets_of
from glrt.scene.model_files.gltf.document import Document, number
from glrt.scene.model_files.gltf.draco import unpacked


class Attributes:
    """The vertex attributes of a primitive, by name."""

    def __init__(
        self,
        document: Document,
        primitive: dict[str, Any],
        here: str,
        weights: Sequence[float] = (),
    ) -> None:
        """Read a primitive; its morph targets are added by `weights`."""
        self._document, self._primitive, self._here = document, primitive, here
        self._named = document.table(primitive.get("attributes"), f"{here}.attributes")
        self._packed = unpacked(document, primitive, here)
        targets = document.list(primitive.get("targets", []), f"{here}.targets")
        self._targets = [
            (weight, document.table(target, f"{here}.targets[{place}]"), place)
            for place, (weight, target) in enumerate(zip(weights, targets, strict=False))
            if weight
        ]

    @cached_property
    def points(self) -> Floats:
        """Positions of the vertices, (v, 3); ValueError without any."""
        found = self.rows("POSITION", (3,))
        if found is None:
            raise ContentError(f"{self._here}.attributes has no POSITION")
        return found

    def rows(self, name: str, sizes: tuple[int, ...]) -> Floats | None:
        """Return an attribute, (v, one of sizes); None if the primitive lacks it."""
        here = f"{self._here}.attributes.{name}"
        if self._packed is not None and name in self._packed.rows:
            found = self._packed.rows[name].copy()
            if found.shape[1] not in sizes:
                raise ContentError(f"{here} has {found.shape[1]} numbers each")
        elif name in self._named:
            found = floats(self._document, self._named[name], sizes, here)
        else:
            return None
        for weight, target, place in self._targets:
            if name in target:
                where = f"{self._here}.targets[{place}].{name}"
                widths = tuple(range(2, found.shape[1] + 1))
                added = floats(self._document, target[name], widths, where)
                if len(added) != len(found):
                    raise ContentError(
                        f"{where} has {len(added):,} rows, and {here} {len(found):,}"
                    )
                found[:, : added.shape[1]] += weight * added
        if name != "POSITION" and len(found) != len(self.points):
            raise ContentError(
                f"{self._here} has {len(self.points):,} places and {len(found):,} of {name}"
            )
        return found

    @property
    def coordinates(self) -> Floats | None:
        """Both sets of texture coordinates, (v, 4), 0 where one lacks; None without any."""
        found = [self.rows(name_of(it), (2,)) for it in sets_of(self._document).kept]
        if all(rows is None for rows in found):
            return None
        empty = np.zeros((len(self.points), 2))
        return np.concatenate([empty if rows is None else rows for rows in found], axis=1)

    def corners(self) -> Ints | None:
        """Return the numbers of vertices, (n,); None where they follow each other."""
        if self._packed is not None:
            return self._packed.corners
        if "indices" not in self._primitive:
            return None
        return indices(self._document, self._primitive["indices"], f"{self._here}.indices")


def weights_of(document: Document, node: dict[str, Any], mesh: dict[str, Any]) -> list[float]:
    """Return the weights of a mesh's morph targets at a node, in the pose of the file."""
    given = document.list(node.get("weights", mesh.get("weights", [])), "weights of morph targets")
    return [number(weight, "a weight of a morph target", -1e6, 1e6) for weight in given]
