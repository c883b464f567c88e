"""Placements of the meshes, cameras and lights of a glTF file."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.animation.rotations import matrix
from glrt.scene.model_files.gltf.document import Document, numbers

Matrix = NDArray[np.float64]  # (4, 4)


class Placed(NamedTuple):
    """A node of the scene, with its transform."""

    node: dict[str, Any]
    number: int
    matrix: Matrix  # from its coordinates to those of the file


def placed_nodes(
    document: Document, changes: Mapping[int, Mapping[str, Any]] = {}
) -> Iterator[Placed]:
    """Yield the nodes of the scene that the file shows, parents before children.

    Without scenes, it yields all nodes. `changes` are other values of nodes by number. ValueError
    for a node below itself, or below two others.
    """
    waiting = [(index, np.eye(4)) for index in reversed(_roots(document))]
    seen = set[int]()
    while waiting:
        index, around = waiting.pop()
        node, here = document.item("nodes", index, "a scene or a node"), f"nodes[{index}]"
        if index in seen:
            raise ValueError(f"{here} stands below itself, or in two places")
        seen.add(index)
        if index in changes:
            node = changed(node, changes[index])
        matrix = checked_matrix(around @ matrix_of(node, here), here)
        yield Placed(node, index, matrix)
        children = document.list(node.get("children", []), f"{here}.children")
        waiting += [(child, matrix) for child in reversed(children)]


def _roots(document: Document) -> list[Any]:
    if not document.items("scenes"):
        nodes = document.items("nodes")
        below = {
            child
            for node in nodes
            if isinstance(node, dict)
            for child in node.get("children", [])
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
        raise ValueError(f"{here}: its transforms lead beyond all numbers")
    return matrix


def matrix_of(node: Mapping[str, Any], here: str) -> Matrix:
    """Return the matrix of a node, (4, 4), to the coordinates of its parent."""
    if "matrix" in node:  # column by column
        return np.array(numbers(node["matrix"], 16, f"{here}.matrix")).reshape(4, 4).T
    move = numbers(node.get("translation", [0, 0, 0]), 3, f"{here}.translation")
    turn = numbers(node.get("rotation", [0, 0, 0, 1]), 4, f"{here}.rotation")
    scale = numbers(node.get("scale", [1, 1, 1]), 3, f"{here}.scale")
    if not any(turn):
        raise ValueError(f"{here}.rotation must not be zero")
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = matrix(turn) * np.array(scale), move
    return found
