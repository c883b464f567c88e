"""Unpack primitives that KHR_draco_mesh_compression has compressed."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import ContentError
from glrt.core.install import install
from glrt.scene.meshes.triangle_meshes import MOST_TRIANGLES
from glrt.scene.model_files.gltf.accessors import Floats, Ints
from glrt.scene.model_files.gltf.document import Document

EXTENSION = "KHR_draco_mesh_compression"


class NotInstalledError(Exception):
    """A library that a file needs is missing."""


class Unpacked(NamedTuple):
    """A primitive after decompression."""

    rows: dict[str, Floats]  # (v, size) by attribute
    corners: Ints  # (3 n,)


def unpacked(document: Document, primitive: dict[str, Any], here: str) -> Unpacked | None:
    """Return the rows and corners of a compressed primitive; None if it is not compressed.

    Raises ValueError for damaged content, and `NotInstalledError` without DracoPy.
    """
    own = document.extension(primitive, EXTENSION, here)
    if own is None:
        return None
    here = f"{here}.extensions.{EXTENSION}"
    content, _ = document.view(own.get("bufferView"), f"{here}.bufferView")
    found = _decoded(bytes(content), here)
    data = {each["unique_id"]: each["data"] for each in found.attributes}
    rows = {}
    for name, number in document.table(own.get("attributes"), f"{here}.attributes").items():
        if type(number) is not int or number not in data:
            raise ContentError(f"{here}.attributes.{name} names a part that there is not")
        normalized = _is_normalized(document, primitive, name, here)
        rows[name] = _numbers(data[number], normalized)
    return Unpacked(rows, np.asarray(found.faces, np.int64).ravel())


def _decoded(content: bytes, here: str) -> Any:
    try:
        import DracoPy
    except ImportError:
        raise NotInstalledError(
            "is compressed by Draco, and DracoPy, which unpacks it, is not installed. Install it "
            f"by: {install('draco')}"
        ) from None
    try:
        found = DracoPy.decode(content)
    except Exception:  # its own types, and those of what it calls
        raise ContentError(f"{here} is damaged: DracoPy cannot unpack it") from None
    if not hasattr(found, "faces"):
        raise ContentError(f"{here} holds points alone")
    if len(found.faces) > MOST_TRIANGLES:
        raise ContentError(f"it has more than {MOST_TRIANGLES:,} triangles")
    return found


def _is_normalized(document: Document, primitive: dict[str, Any], name: str, here: str) -> bool:
    attributes = document.table(primitive.get("attributes"), f"{here}: attributes")
    if name not in attributes:
        return False
    return document.item("accessors", attributes[name], here).get("normalized") is True


def _numbers(data: NDArray[Any], normalized: bool) -> Floats:
    found = data.reshape(len(data), -1).astype(np.float64)
    if normalized and data.dtype.kind in "iu":
        found = np.maximum(found / np.iinfo(data.dtype).max, -1.0)
    return found
