"""The triangles of the meshes of a glTF file, where its nodes place them."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from glrt.scene.meshes.checked_meshes import MeshArrays, of_file
from glrt.scene.meshes.triangle_meshes import MOST_TRIANGLES, NO_MATERIAL, TriangleMesh
from glrt.scene.model_files.gltf.accessors import Floats, Ints, floats
from glrt.scene.model_files.gltf.attributes import Attributes, weights_of
from glrt.scene.model_files.gltf.document import Document
from glrt.scene.model_files.gltf.nodes import Matrix, Placed, placed_nodes
from glrt.scene.model_files.gltf.variants import Choices, choices_of, variant_names


def skin_matrices(
    document: Document,
    placed: Placed,
    own: Attributes,
    poses: Mapping[int, Matrix],
    here: str,
) -> Floats | None:
    """Return a matrix for each vertex, (v, 4, 4), in place of its node's; None without a skin.

    `poses` are the transforms of all nodes that the file shows. ValueError for data that do not
    fit.
    """
    joined = own.rows("JOINTS_0", (4,)) if "skin" in placed.node else None
    if joined is None:
        return None
    index = placed.node["skin"]
    skin, name = document.item("skins", index, f"nodes[{placed.number}].skin"), f"skins[{index}]"
    joints = document.list(skin.get("joints"), f"{name}.joints")
    bound = np.broadcast_to(np.eye(4), (len(joints), 4, 4))
    if "inverseBindMatrices" in skin:
        rows = floats(document, skin["inverseBindMatrices"], (16,), f"{name}.inverseBindMatrices")
        if len(rows) < len(joints):
            raise ValueError(f"{name} has {len(joints)} joints and {len(rows)} matrices")
        bound = rows[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1)
    moved = np.array([poses.get(joint, np.eye(4)) for joint in joints]).reshape(-1, 4, 4) @ bound
    at, share = joined.astype(int), own.rows("WEIGHTS_0", (4,))
    if share is None:
        raise ValueError(f"{here}.attributes has JOINTS_0 and no WEIGHTS_0")
    if len(at) != len(share) or not len(joints) or at.min() < 0 or at.max() >= len(joints):
        raise ValueError(f"{here} names joints that {name} has not")
    total = share.sum(axis=1, keepdims=True)
    share = np.divide(share, total, out=np.zeros_like(share), where=total > 0)
    matrices: Floats = np.einsum("vk,vkij->vij", share, moved[at])
    return matrices


_TRIANGLES, _STRIP, _FAN = 4, 5, 6
_WITHOUT_AREA = (0, 1, 2, 3)  # points and lines


class _Part(NamedTuple):
    """A primitive in the coordinates of the file."""

    points: Floats  # (v, 3)
    faces: Ints  # (n, 3)
    normals: Floats  # (v, 3)
    colors: Floats | None
    uv: Floats | None  # (v, 4): both sets
    tangents: Floats | None  # (v, 3)
    materials: Choices = Choices(None, ())


def mesh_of(document: Document, changes: Mapping[int, Mapping[str, Any]] = {}) -> TriangleMesh:
    """Return all triangles that the file shows; `material_names` names their materials.

    `changes` are other values of nodes by number, as an animation gives them.
    """
    variants, parts, count = variant_names(document), list[_Part](), 0
    nodes = list(placed_nodes(document, changes))
    poses = {placed.number: placed.matrix for placed in nodes}
    for placed in nodes:
        if "mesh" not in placed.node:
            continue
        for part in _parts(document, placed, len(variants), poses):
            parts.append(part)
            count += len(part.faces)
            if count > MOST_TRIANGLES:
                raise ValueError(f"it has more than {MOST_TRIANGLES:,} triangles")
    if not parts:
        raise ValueError("it shows no triangles")
    counts = [len(part.points) for part in parts]
    firsts = np.cumsum([0, *counts[:-1]])
    faces = [part.faces + first for part, first in zip(parts, firsts, strict=True)]
    kinds = list(dict.fromkeys(part.materials for part in parts))
    sorts = [np.full(len(part.faces), kinds.index(part.materials)) for part in parts]
    names = [*material_names(document), NO_MATERIAL]  # the last one for None
    looks = [[names[-1 if k is None else k] for k in (it.usual, *it.varied)] for it in kinds]
    usual, *varied = map(tuple, zip(*looks, strict=True))
    used = list(dict.fromkeys(usual))
    labels = np.array([used.index(name) for name in usual])
    found = of_file(
        MeshArrays(
            np.concatenate([part.points for part in parts]),
            np.concatenate(faces),
            np.concatenate([part.normals for part in parts]),
            _joined([part.colors for part in parts], counts, 3, 1.0),
            tuple(used),
            labels[np.concatenate(sorts)],
            _joined([part.uv for part in parts], counts, 4, 0.0),
            None,
            _joined([part.tangents for part in parts], counts, 3, 0.0),
            np.concatenate(sorts),
        )
    )
    return replace(found, variants=dict(zip(variants, varied, strict=True)))


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


def _joined(parts: list[Floats | None], counts: list[int], width: int, rest: float) -> Any:
    """Return rows of all parts, `rest` where a part has none; None if no part has any."""
    if all(part is None for part in parts):
        return None
    filled = [
        np.full((count, width), rest) if part is None else part
        for part, count in zip(parts, counts, strict=True)
    ]
    return np.concatenate(filled)


def _parts(
    document: Document, placed: Placed, variants: int, poses: Mapping[int, Matrix]
) -> Iterator[_Part]:
    index = placed.node["mesh"]
    mesh = document.item("meshes", index, f"nodes[{placed.number}].mesh")
    primitives = document.list(mesh.get("primitives"), f"meshes[{index}].primitives")
    for place, primitive in enumerate(primitives):
        here = f"meshes[{index}].primitives[{place}]"
        table = document.table(primitive, here)
        attributes = document.table(table.get("attributes"), f"{here}.attributes")
        if table.get("mode", _TRIANGLES) in _WITHOUT_AREA or "POSITION" not in attributes:
            continue  # points, lines, and primitives that need an extension
        weights = weights_of(document, placed.node, mesh)
        rows = Attributes(document, table, here, weights)
        posed = skin_matrices(document, placed, rows, poses, here)
        matrices = placed.matrix[None] if posed is None else posed
        found = _part(rows, table.get("mode", _TRIANGLES), here, matrices)
        if found:
            yield found._replace(materials=choices_of(document, table, variants, here))


def _part(own: Attributes, mode: Any, here: str, matrices: Floats) -> _Part | None:
    """Return a primitive with vertices moved by matrices, (1 or v, 4, 4); None if empty."""
    points = own.points
    faces = _faces(own, mode, len(points), here)
    if not len(faces):
        return None
    if len(matrices) not in (1, len(points)):
        raise ValueError(f"{here} has {len(points):,} places and {len(matrices):,} of JOINTS_0")
    colors = own.rows("COLOR_0", (3, 4))
    first, second = own.rows("TEXCOORD_0", (2,)), own.rows("TEXCOORD_1", (2,))
    columns = colors[:, :3].clip(0, 1) if colors is not None else None
    empty = np.zeros((len(points), 2))
    sets = (first if first is not None else empty, second if second is not None else empty)
    uv = None if first is None and second is None else np.concatenate(sets, axis=1)
    normals = own.rows("NORMAL", (3,))
    linear = matrices[:, :3, :3]
    moved = (linear @ points[:, :, None])[:, :, 0] + matrices[:, :3, 3]
    if np.linalg.det(linear[0]) < 0:
        faces = faces[:, ::-1]
    if normals is None:  # flat facets: triangles share no vertices then
        at = faces.ravel()
        corners = moved[faces]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        facing = across.repeat(3, axis=0)
        columns, uv = (None if rows is None else rows[at] for rows in (columns, uv))
        order = np.arange(len(at)).reshape(-1, 3)
        return _Part(moved[at], order, facing, columns, uv, None)  # without tangents, by glTF
    turned = (_for_normals(linear) @ normals[:, :, None])[:, :, 0]
    tangents = own.rows("TANGENT", (4,))
    if tangents is not None:  # their sign is that of the texture coordinates
        tangents = (linear @ tangents[:, :3, None])[:, :, 0]
    return _Part(moved, faces, turned, columns, uv, tangents)


def _for_normals(linear: Floats) -> Floats:
    """Return matrices for normals, (n, 3, 3): scaled cofactors, which need no inverse."""
    a, b, c = (linear[:, :, axis] for axis in range(3))
    cofactors = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=2)
    sign = np.where(np.linalg.det(linear) < 0, -1.0, 1.0)
    largest = np.abs(cofactors).max(axis=(1, 2))
    scale = np.divide(sign, largest, out=np.zeros_like(sign), where=largest > 0)
    turned: Floats = cofactors * scale[:, None, None]
    return turned


def _faces(own: Attributes, mode: Any, count: int, here: str) -> Ints:
    """Return the faces, (n, 3), of a list, a strip or a fan of triangles."""
    if mode not in (_TRIANGLES, _STRIP, _FAN):
        raise ValueError(f"{here}.mode must be a whole number from 0 to 6, got {mode!r}"[:200])
    order = own.corners()
    if order is None:
        order = np.arange(count)
    elif order.max(initial=-1) >= count:
        raise ValueError(f"{here}.indices names vertex {order.max()}, of {count:,} from 0")
    if mode == _TRIANGLES:
        if len(order) % 3:
            raise ValueError(f"{here} has {len(order):,} corners, which is no multiple of three")
        return order.reshape(-1, 3)
    if len(order) < 3:
        return np.zeros((0, 3), np.int64)
    if mode == _FAN:
        around = np.broadcast_to(order[0], len(order) - 2)
        return np.stack([around, order[1:-1], order[2:]], axis=1)
    strip = np.stack([order[:-2], order[1:-1], order[2:]], axis=1)
    strip[1::2] = strip[1::2, [1, 0, 2]]
    return strip
