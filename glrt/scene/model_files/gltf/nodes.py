"""Placements of the meshes, cameras and lights of a glTF file."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import ContentError
from glrt.scene.animation.rotations import matrix
from glrt.scene.model_files.gltf.document import Document, numbers

Matrix = NDArray[np.float64]  # (4, 4)


class Placed(NamedTuple):
    """A node of the scene, with its transform."""

    node: dict[str, Any]
    number: int
    matrix: Matrix  # from its coordinates to those of the file


def placed_nodes(document: Document, changes: Mapping[int, Mapping[str, Any]] = {}) -> list[Placed]:
    """Return the nodes of the scene that the file shows, parents before children.

    Without scenes, these are all nodes. `changes` are other values of nodes by number. ValueError
    for a node below itself, or below two others.
    """
    if changes:
        return _placed(document, changes)
    return document.once("nodes", lambda: _placed(document, {}))


def _placed(document: Document, changes: Mapping[int, Mapping[str, Any]]) -> list[Placed]:
    found = list(_in_order(document))
    nodes, places = list[dict[str, Any]](), np.empty((len(found), 4, 4))
    for row, (index, node, _, _) in enumerate(found):
        nodes.append(changed(node, changes[index]) if index in changes else node)
        places[row] = matrix_of(nodes[row], f"nodes[{index}]")
    above = np.array([row for _, _, row, _ in found], np.int64)
    depth = np.array([steps for _, _, _, steps in found], np.int64)
    order = np.argsort(depth, kind="stable")
    for level in np.split(order, np.cumsum(np.bincount(depth))[:-1])[1:] if len(found) else ():
        places[level] = places[above[level]] @ places[level]
    wrong = ~np.isfinite(places).all(axis=(1, 2))
    if wrong.any():
        first = int(wrong.argmax())
        checked_matrix(places[first], f"nodes[{found[first][0]}]")
    numbers = (index for index, _, _, _ in found)
    return [Placed(*each) for each in zip(nodes, numbers, places, strict=True)]


def _in_order(document: Document) -> Iterator[tuple[int, dict[str, Any], int, int]]:
    """Yield number and table of each node, the row of the node above it, and how many are above."""
    waiting = [(index, 0, 0) for index in reversed(_roots(document))]
    seen = set[int]()
    while waiting:
        index, above, steps = waiting.pop()
        node = document.item("nodes", index, "a scene or a node")
        if index in seen:
            raise ContentError(f"nodes[{index}] stands below itself, or in two places")
        row = len(seen)
        seen.add(index)
        yield index, node, above, steps
        if "children" in node:
            children = document.list(node["children"], f"nodes[{index}].children")
            waiting += [(child, row, steps + 1) for child in reversed(children)]


def _roots(document: Document) -> list[Any]:
    if not document.items("scenes"):
        nodes = document.items("nodes")
        below = {
            child
            for node in nodes
            if isinstance(node, dict)
            for child in document.list(node.get("children", []), "children")
            if type(child) is int
        }
        return [index for index in range(len(nodes)) if index not in below]
    shown = document.item("scenes", document.json.get("scene", 0), "scene")
    return document.list(shown.get("nodes", []), "nodes of the scene")


def changed(node: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return a node with other values of its translation, rotation, scale or weights."""
    return {key: value for key, value in node.items() if key != "matrix"} | dict(values)


def checked_matrix(matrix: Matrix, here: str) -> Matrix:
    """Return the matrix; ValueError if a number of it is not finite."""
    if not np.isfinite(matrix).all():
        raise ContentError(f"{here}: its transforms lead beyond all numbers")
    return matrix


def matrix_of(node: Mapping[str, Any], here: str) -> Matrix:
    """Return the matrix of a node, (4, 4), to the coordinates of its parent."""
    if "matrix" in node:  # column by column
        return np.array(numbers(node["matrix"], 16, f"{here}.matrix")).reshape(4, 4).T
    found = _STILL.copy()
    if "translation" in node:
        found[:3, 3] = numbers(node["translation"], 3, f"{here}.translation")
    if "rotation" in node:
        turn = numbers(node["rotation"], 4, f"{here}.rotation")
        if not any(turn):
            raise ContentError(f"{here}.rotation must not be zero")
        found[:3, :3] = matrix(turn)
    if "scale" in node:
        found[:3, :3] *= numbers(node["scale"], 3, f"{here}.scale")
    return found


_STILL = np.eye(4)
