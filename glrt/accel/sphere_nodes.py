"""The BVH over the spheres as rows of the struct `Node` of structs/shapes.glsl, 32 bytes each.

Corners of boxes are stored as 16-bit coordinates on a grid, in cells, rounded outwards. The grid
covers the boxes below the root. The root itself holds the largest sphere, so that a huge sphere
used as ground does not make the cells large.
"""

import math
from typing import Any

import numpy as np

from glrt.accel import bvh

Array = np.ndarray[Any, Any]

# Relative margin of boxes, and of rays in shapes/sphere_tree.glsl: far above float32 rounding.
SLACK = 2.0**-18
MOST_CELLS = 2**16 - 1  # along each axis of the grid


def pack_nodes(spheres: Array, dtype: np.dtype[Any], known: Array | None = None) -> Array:
    """Return rows of Node for `spheres`, n rows of Sphere: one for the grid, then n nodes.

    Boxes are wide enough for intersection tests in float32. Without spheres there are no rows.
    `known` are the rows of the same spheres relative to another camera position; the new tree
    takes over their topology.
    """
    if not len(spheres):
        return np.zeros(0, dtype)
    center, radius = spheres["center"].astype(float), spheres["radius"].astype(float)[:, None]
    slack = SLACK * (np.abs(center).max(axis=1, keepdims=True) + radius)
    boxes = center - radius - slack, center + radius + slack
    tree = bvh.build(*boxes) if known is None else bvh.refit(*_order(known), *boxes)
    corner, cell = _grid(tree.lower[0], tree.upper[0])
    rows = np.zeros(1 + len(spheres), dtype)
    rows["sphere"][0] = np.array([*corner, cell], np.float32).view(np.uint32)
    rows["sphere"][1:, :3] = spheres["center"][tree.item].view(np.uint32)
    rows["sphere"][1:, 3] = spheres["radius"][tree.item].view(np.uint32)
    lower = np.floor((tree.lower - corner) / cell).clip(0, MOST_CELLS).astype(np.uint32)
    upper = np.ceil((tree.upper - corner) / cell).clip(0, MOST_CELLS).astype(np.uint32)
    below = tree.skip - np.arange(len(spheres)) - 1
    rows["box"][1:, :3] = lower | upper << 16
    rows["box"][1:, 3] = (tree.item | below << 16).astype(np.uint32)
    return rows


def _order(nodes: Array) -> tuple[Array, Array]:
    """Return `item` and `skip` of a packed tree (see `bvh.Tree`), (n,) each."""
    links = nodes["box"][1:, 3].astype(int)
    return links & 0xFFFF, (links >> 16) + np.arange(len(links)) + 1


def _grid(lower: Array, upper: Array) -> tuple[Array, float]:
    """Return lower corner, exact in float32, and cell edge, a power of 2, of a grid over a box."""
    nearest = lower.astype(np.float32)
    corner = np.where(nearest > lower, np.nextafter(nearest, np.float32(-np.inf)), nearest)
    extent = float((upper - corner).max())
    return corner.astype(float), 2.0 ** max(math.frexp(extent / MOST_CELLS)[1], -126)
