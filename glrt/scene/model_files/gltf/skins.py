"""Skins of a glTF file: how joints move the vertices of a primitive."""

from collections.abc import Iterator, Mapping

import numpy as np

from glrt.core.errors import ContentError
from glrt.scene.model_files.gltf.accessors import Floats, floats
from glrt.scene.model_files.gltf.attributes import Attributes
from glrt.scene.model_files.gltf.document import Document
from glrt.scene.model_files.gltf.nodes import Matrix, Placed


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
    sets = list(_sets(own, here)) if "skin" in placed.node else []
    if not sets:
        return None
    index = placed.node["skin"]
    skin, name = document.item("skins", index, f"nodes[{placed.number}].skin"), f"skins[{index}]"
    joints = document.list(skin.get("joints"), f"{name}.joints")
    bound = np.broadcast_to(np.eye(4), (len(joints), 4, 4))
    if "inverseBindMatrices" in skin:
        rows = floats(document, skin["inverseBindMatrices"], (16,), f"{name}.inverseBindMatrices")
        if len(rows) < len(joints):
            raise ContentError(f"{name} has {len(joints)} joints and {len(rows)} matrices")
        bound = rows[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1)
    for place, joint in enumerate(joints):
        document.item("nodes", joint, f"{name}.joints[{place}]")
    moved = np.array([poses.get(joint, np.eye(4)) for joint in joints]).reshape(-1, 4, 4) @ bound
    at, share = (np.concatenate(rows, axis=1) for rows in zip(*sets, strict=True))
    at = at.astype(int)
    if not len(joints) or at.min() < 0 or at.max() >= len(joints):
        raise ContentError(f"{here} names joints that {name} has not")
    total = share.sum(axis=1, keepdims=True)
    share = np.divide(share, total, out=np.zeros_like(share), where=total > 0)
    matrices: Floats = np.einsum("vk,vkij->vij", share, moved[at])
    return matrices


def _sets(own: Attributes, here: str) -> Iterator[tuple[Floats, Floats]]:
    """Yield joints and weights of each vertex, (v, 4) each, until a set is missing."""
    number = 0
    while (joints := own.rows(f"JOINTS_{number}", (4,))) is not None:
        weights = own.rows(f"WEIGHTS_{number}", (4,))
        if weights is None:
            raise ContentError(f"{here}.attributes has JOINTS_{number} and no WEIGHTS_{number}")
        yield joints, weights
        number += 1
