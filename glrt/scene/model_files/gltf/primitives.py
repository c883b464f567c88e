"""The triangles of the meshes of a glTF file, where its nodes place them."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from glrt.core.errors import ContentError, NothingShownError
from glrt.scene.meshes.checked_meshes import MeshArrays, of_file
from glrt.scene.meshes.triangle_meshes import MOST_TRIANGLES, NO_MATERIAL, TriangleMesh
from glrt.scene.model_files.gltf.accessors import Floats, Ints
from glrt.scene.model_files.gltf.attributes import Attributes, weights_of
from glrt.scene.model_files.gltf.document import Document
from glrt.scene.model_files.gltf.nodes import Matrix, Placed, placed_nodes
from glrt.scene.model_files.gltf.skins import skin_matrices
from glrt.scene.model_files.gltf.variants import Choices, choices_of, variant_names

_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_WITHOUT_AREA = (0, 1, 2, 3)  # points and lines


class _Shown(NamedTuple):
    """A primitive in the coordinates of the file, at each of k nodes that show it in one shape."""

    slots: Ints  # (k,): places in the order of the file
    points: Floats  # (k, v, 3)
    faces: Ints  # (k, n, 3)
    normals: Floats  # (k, v, 3)
    colors: Floats | None  # (v, 3)
    uv: Floats | None  # (v, 4): both sets
    tangents: Floats | None  # (k, v, 3)
    materials: Choices


class _Group(NamedTuple):
    """Nodes that show one primitive in one shape, by which it is read once."""

    primitive: dict[str, Any]
    here: str
    weights: tuple[float, ...]  # of its morph targets
    nodes: list[Placed]
    slots: list[int]


def mesh_of(document: Document, changes: Mapping[int, Mapping[str, Any]] = {}) -> TriangleMesh:
    """Return all triangles that the file shows; `material_names` names their materials.

    `changes` are other values of nodes by number, as an animation gives them.
    """
    variants = variant_names(document)
    nodes = placed_nodes(document, changes)
    poses = {placed.number: placed.matrix for placed in nodes}
    shown, room = list[_Shown](), MOST_TRIANGLES
    for group in _groups(document, nodes):
        choices = choices_of(document, group.primitive, len(variants), group.here)
        found = _shown(document, group, poses, choices, room)
        if found:
            shown.append(found)
            room -= found.faces.shape[0] * found.faces.shape[1]
    if not shown:
        raise NothingShownError("no node of its scene has a mesh of them")
    joined, kinds = _joined(shown)
    names = [*material_names(document), NO_MATERIAL]  # the last one for None
    looks = [[names[-1 if k is None else k] for k in (it.usual, *it.varied)] for it in kinds]
    usual, *varied = map(tuple, zip(*looks, strict=True))
    used = list(dict.fromkeys(usual))
    labels = np.array([used.index(name) for name in usual])
    mesh = of_file(joined._replace(names=tuple(used), labels=labels[joined.sorts]))
    return replace(mesh, variants=dict(zip(variants, varied, strict=True)))


def _joined(shown: list[_Shown]) -> tuple[MeshArrays, list[Choices]]:
    """Return the arrays of all primitives in the order of the file, and the kinds of choices.

    `sorts` are numbers of those kinds.
    """
    count = 1 + max(int(it.slots.max()) for it in shown)
    sizes, lengths, kind = (np.zeros(count, np.int64) for _ in range(3))
    for it in shown:
        sizes[it.slots], lengths[it.slots] = it.points.shape[1], it.faces.shape[1]
    starts, firsts = np.cumsum(sizes) - sizes, np.cumsum(lengths) - lengths
    kinds = list(dict.fromkeys(it.materials for it in sorted(shown, key=lambda it: it.slots[0])))
    faces = np.empty((int(lengths.sum()), 3), np.int64)
    for it in shown:
        kind[it.slots] = kinds.index(it.materials)
        rows = firsts[it.slots][:, None] + np.arange(it.faces.shape[1])
        faces[rows] = it.faces + starts[it.slots][:, None, None]

    def spread(values: list[Floats | None], width: int, rest: float) -> Any:
        """Rows of all primitives, `rest` where one has none; None if no primitive has any."""
        if all(value is None for value in values):
            return None
        found = np.full((int(sizes.sum()), width), rest)
        for it, value in zip(shown, values, strict=True):
            if value is not None:
                found[starts[it.slots][:, None] + np.arange(value.shape[-2])] = value
        return found

    arrays = MeshArrays(
        spread([it.points for it in shown], 3, 0.0),
        faces,
        spread([it.normals for it in shown], 3, 0.0),
        spread([it.colors for it in shown], 3, 1.0),
        uv=spread([it.uv for it in shown], 4, 0.0),
        tangents=spread([it.tangents for it in shown], 3, 0.0),
        sorts=np.repeat(kind, lengths),
    )
    return arrays, kinds


def material_names(document: Document) -> list[str]:
    """Return a different name for each material: its own, or one such as `material 3`."""
    found = list[str]()
    for index, material in enumerate(document.items("materials")):
        given = document.table(material, f"materials[{index}]").get("name")
        name = _one_line(given) if isinstance(given, str) else ""
        if not name or name in found or name == NO_MATERIAL:
            name = f"{name or 'material'} {index}"
        while name in found:
            name += "'"
        found.append(name)
    return found


def _one_line(text: str) -> str:
    return "".join(letter for letter in text if letter.isprintable()).strip()[:200]


def _groups(document: Document, nodes: list[Placed]) -> Iterable[_Group]:
    """Return the primitives that the nodes show; a skin gives each node a group of its own."""
    found, slot = dict[object, _Group](), 0
    for placed in nodes:
        if "mesh" not in placed.node:
            continue
        index = placed.node["mesh"]
        mesh = document.item("meshes", index, f"nodes[{placed.number}].mesh")
        weights = tuple(weights_of(document, placed.node, mesh))
        skinned = placed.number if "skin" in placed.node else None
        primitives = document.list(mesh.get("primitives"), f"meshes[{index}].primitives")
        for place, primitive in enumerate(primitives):
            key = index, place, weights, skinned
            if key not in found:
                here = f"meshes[{index}].primitives[{place}]"
                found[key] = _Group(document.table(primitive, here), here, weights, [], [])
            found[key].nodes.append(placed)
            found[key].slots.append(slot)
            slot += 1
    return found.values()


def _shown(
    document: Document,
    group: _Group,
    poses: Mapping[int, Matrix],
    choices: Choices,
    room: int,
) -> _Shown | None:
    """Return a primitive at its nodes, of at most `room` triangles; None if it has no area."""
    table, here = group.primitive, group.here
    mode = table.get("mode", _TRIANGLES)
    attributes = document.table(table.get("attributes"), f"{here}.attributes")
    if mode in _WITHOUT_AREA or "POSITION" not in attributes:
        return None  # points, lines, and primitives that need an extension
    own = Attributes(document, table, here, group.weights)
    posed = skin_matrices(document, group.nodes[0], own, poses, here)
    faces = _faces(own, mode, len(own.points), here)
    if not len(faces):
        return None
    if len(group.nodes) * len(faces) > room:
        raise ContentError(f"it has more than {MOST_TRIANGLES:,} triangles")
    matrices = (
        np.array([it.matrix for it in group.nodes])[:, None] if posed is None else posed[None]
    )
    return _moved(own, faces, matrices, np.array(group.slots))._replace(materials=choices)


def _moved(own: Attributes, faces: Ints, matrices: Floats, slots: Ints) -> _Shown:
    """Return a primitive moved by matrices, (k, 1 or v, 4, 4): one for each node, or vertex."""
    points, nobody = own.points, Choices(None, ())
    colors = own.rows("COLOR_0", (3, 4))
    columns = colors[:, :3].clip(0, 1) if colors is not None else None
    uv, normals = own.coordinates, own.rows("NORMAL", (3,))
    linear = matrices[..., :3, :3]
    moved = (linear @ points[:, :, None])[..., 0] + matrices[..., :3, 3]
    mirrors = np.linalg.det(linear[:, 0]) < 0
    each = np.where(mirrors[:, None, None], faces[:, ::-1], faces)
    if normals is None:  # flat facets: triangles share no vertices then
        at = np.arange(len(slots))[:, None], each.reshape(len(slots), -1)
        corners = moved[at].reshape(len(slots), -1, 3, 3)
        across = np.cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
        facing = across.repeat(3, axis=1)
        columns, uv = (None if rows is None else rows[at[1]] for rows in (columns, uv))
        order = np.broadcast_to(np.arange(3 * len(faces)).reshape(-1, 3), each.shape)
        return _Shown(slots, moved[at], order, facing, columns, uv, None, nobody)  # by glTF
    turned = (_for_normals(linear) @ normals[:, :, None])[..., 0]
    tangents = own.rows("TANGENT", (4,))
    if tangents is not None:  # their sign is that of the texture coordinates
        tangents = (linear @ tangents[:, :3, None])[..., 0]
    return _Shown(slots, moved, each, turned, columns, uv, tangents, nobody)


def _for_normals(linear: Floats) -> Floats:
    """Return matrices for normals, (..., 3, 3): scaled cofactors, which need no inverse."""
    a, b, c = (linear[..., axis] for axis in range(3))
    cofactors = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=-1)
    sign = np.where(np.linalg.det(linear) < 0, -1.0, 1.0)
    largest = np.abs(cofactors).max(axis=(-2, -1))
    scale = np.divide(sign, largest, out=np.zeros_like(sign), where=largest > 0)
    turned: Floats = cofactors * scale[..., None, None]
    return turned


def _faces(own: Attributes, mode: Any, count: int, here: str) -> Ints:
    """Return the faces, (n, 3), of a list, a strip or a fan of triangles."""
    if mode not in (_TRIANGLES, _STRIP, _FAN):
        raise ContentError(f"{here}.mode must be a whole number from 0 to 6, got {mode!r}"[:200])
    order = own.corners()
    if order is None:
        order = np.arange(count)
    elif order.max(initial=-1) >= count:
        raise ContentError(f"{here}.indices names vertex {order.max()}, of {count:,} from 0")
    if mode == _TRIANGLES:
        if len(order) % 3:
            raise ContentError(f"{here} has {len(order):,} corners, which is no multiple of three")
        return order.reshape(-1, 3)
    if len(order) < 3:
        return np.zeros((0, 3), np.int64)
    if mode == _FAN:
        around = np.broadcast_to(order[0], len(order) - 2)
        return np.stack([around, order[1:-1], order[2:]], axis=1)
    strip = np.stack([order[:-2], order[1:-1], order[2:]], axis=1)
    strip[1::2] = strip[1::2, [1, 0, 2]]
    return strip
