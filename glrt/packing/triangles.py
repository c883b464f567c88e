"""The triangles of all meshes of a scene, relative to the middle of the BVH over shapes.

So they stay the same when the camera moves: the kernel transforms the origins of rays to that
frame. docs/explanation/meshes.md explains why.
"""

from collections.abc import Collection, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from glrt.accel.shape_tree import Boxes
from glrt.accel.split_boxes import boxes_of
from glrt.accel.triangle_pairs import Pairs, paired
from glrt.accel.wide_tree import LEAF, LINK_BITS, SLOT, Grid
from glrt.packing.kernel_structs import CONSTANTS, STRUCTS
from glrt.plan.facts import SceneFacts
from glrt.scene.instancing import distinct
from glrt.scene.shapes.mesh import Mesh

Array = np.ndarray[Any, Any]

PORTION = 1 << 16  # triangles that are packed at once, so that memory is bounded
_OCTANT = 32767  # steps of a normal's coordinate: 16 bits, with 0 and 1 exact


class Triangles(NamedTuple):
    """Corners in scene units, and the triangles between them."""

    position: Array  # (v, 3), float64
    normal: Array  # (v, 3), unit
    face: Array  # (n, 3), int32: numbers of corners
    mesh: Array  # (n,), uint32: numbers of meshes, in the order of the scene
    hides: Array  # (n,), bool: whether rays pass them from behind


def triangles_of(meshes: Sequence[Mesh], without: Collection[int] = ()) -> Triangles:
    """Return the triangles of meshes, one after the other, `without` meshes of these numbers."""
    position, normal, face, mesh, hides, first = [], [], [], [], [], 0
    for number, shape in enumerate(meshes):
        if number in without:
            continue
        points, faces = shape.world_vertices, shape.triangles.faces
        position.append(points)
        normal.append(_unit(shape.world_normals))
        face.append((faces if shape.is_upright else faces[:, ::-1]).astype(np.int32) + first)
        mesh.append(np.full(len(faces), number, np.uint32))
        hides.append(np.full(len(faces), shape.hides_backs))
        first += len(points)
    if not face:
        none, faces = np.zeros((0, 3)), np.zeros((0, 3), np.int32)
        return Triangles(none, none, faces, np.zeros(0, np.uint32), np.zeros(0, bool))
    return Triangles(*map(np.concatenate, (position, normal, face, mesh, hides)))


class PackedTriangles(NamedTuple):
    """Triangles as the kernel reads them."""

    boxes: Boxes  # with their leaves
    corners: Array  # rows of the struct Corner
    triangles: Array  # rows of the struct Triangle


def pack_triangles(found: Triangles, grid: Grid, unit: float = 1.0) -> PackedTriangles:
    """Pack one or more triangles in the frame of a grid, in a unit that is a power of two."""
    local = ((found.position - grid.center) / unit).astype(np.float32)
    exact = local.astype(np.float64)
    pairs = paired(exact, found.face)
    around = boxes_of(exact[pairs.corner])
    corners = around.lower * unit + grid.center, around.upper * unit + grid.center
    leaves = partial(_leaves, local, pairs, _turns(pairs, found), around.pair)
    boxes = Boxes("Triangle", 0, *corners, leaves)
    return PackedTriangles(boxes, _corners(local, found.normal), _triangles(exact, found))


def _turns(pairs: Pairs, found: Triangles) -> Array:
    """Return two bits for each triangle of each pair, (m,) uint32: how corners turn in its leaf.

    They are 1 for corners about the normal and 2 for the other way, 0 where no side is hidden. The
    first triangle has them in its own order (glrt/accel/triangle_pairs.py).
    """
    first, second = pairs.triangle.T
    a, c = pairs.corner[:, :1], pairs.corner[:, 2:3]
    face = found.face[second]
    follows = ((face == a) & (np.roll(face, -1, axis=1) == c)).any(axis=1)
    bits: Array = found.hides[first] | found.hides[second] * np.where(follows, 1, 2) << 2
    return bits.astype(np.uint32)


def _leaves(local: Array, pairs: Pairs, turns: Array, of: Array) -> Array:
    """Return the leaves, (k, SLOT), of the pairs with the numbers `of`, (k,)."""
    rows = np.zeros((len(of), SLOT), np.uint32)
    rows[:, :12] = local[pairs.corner[of]].reshape(-1, 12).view(np.uint32)
    rows[:, 12:14] = pairs.triangle[of]
    rows[:, 14] = turns[of]
    rows[:, 15] = LEAF | CONSTANTS["TRIANGLES"] << LINK_BITS
    return rows


def corner_meshes(facts: SceneFacts) -> list[Mesh]:
    """Return the meshes whose vertices are the rows of the struct Corner, in their order."""
    placed = facts.scene.meshes
    own = distinct([placed[number] for number in facts.instances])[0]
    shared = [mesh for number, mesh in enumerate(placed) if number not in facts.instances]
    return [*shared, *own]


def pack_tints(facts: SceneFacts) -> Array:
    """Return rows of the struct Tint, one for each corner: white where a mesh has no colours.

    There are none if no mesh shows colours.
    """
    if not facts.is_colored:
        return np.zeros(0, STRUCTS["Tint"])
    meshes = [mesh.triangles for mesh in corner_meshes(facts)]
    rows = np.zeros(sum(len(mesh.vertices) for mesh in meshes), STRUCTS["Tint"])
    first = 0
    for mesh in meshes:
        some = slice(first, first + len(mesh.vertices))
        rows["color"][some] = 1 if mesh.colors is None else mesh.colors
        first = some.stop
    return rows


def _corners(local: Array, normal: Array) -> Array:
    rows = np.zeros(len(local), STRUCTS["Corner"])
    rows["position"], rows["normal"] = local, octahedral(normal)
    return rows


def _triangles(exact: Array, found: Triangles) -> Array:
    rows = np.zeros(len(found.face), STRUCTS["Triangle"])
    rows["corners"], rows["owner"] = found.face, found.mesh
    for first in range(0, len(rows), PORTION):
        some = slice(first, first + PORTION)
        corner = exact[found.face[some]]
        across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        rows["normal"][some] = _unit(across)
        rows["reach"][some] = np.abs(corner).max(axis=(1, 2))
    return rows


def _unit(vectors: Array) -> Array:
    """Return vectors, (n, 3), scaled to length 1; vectors without length become the z axis."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    up = np.broadcast_to([0.0, 0.0, 1.0], vectors.shape)
    unit: Array = np.divide(vectors, length, out=up.copy(), where=length > 0)
    return unit


def octahedral(normal: Array) -> Array:
    """Encode unit vectors, (n, 3), as x and y on an unfolded octahedron: (n,) uint32, 16 bits each.

    They are at most 0.004 degrees off. "A Survey of Efficient Representations for Independent Unit
    Vectors" (Cigolle et al., JCGT 2014).
    """
    flat = normal / np.abs(normal).sum(axis=1, keepdims=True)
    x, y, z = flat.T
    folded_x = np.where(z >= 0, x, (1 - np.abs(y)) * np.where(x >= 0, 1, -1))
    folded_y = np.where(z >= 0, y, (1 - np.abs(x)) * np.where(y >= 0, 1, -1))
    steps = [np.rint((value + 1) * _OCTANT).astype(np.uint32) for value in (folded_x, folded_y)]
    packed: Array = steps[0] | steps[1] << 16
    return packed
