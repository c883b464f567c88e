"""STL files as arrays, in text and binary.

The format is 3D Systems' "StereoLithography Interface Specification" of 1989. Normals of facets are
not read: they follow from the corners.
"""

import re
from typing import Any

import numpy as np

from glrt.core.errors import ContentError
from glrt.core.text import counted
from glrt.scene.meshes.checked_meshes import MeshArrays
from glrt.scene.meshes.vertex_means import places
from glrt.scene.model_files.text_lines import number_rows, text_of

_FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
_HEADER, _COUNT, _LOOK = 80, 4, 1000  # bytes
_VERTEX = re.compile(r"\bvertex\s+(\S+\s+\S+\s+\S+)", re.IGNORECASE)


def read_stl(content: bytes) -> tuple[MeshArrays, tuple[str, ...]]:
    """Return the mesh of an STL file, and what is left out: nothing. ValueError says what is wrong.

    Facets in one place share vertices. Bytes behind the last facet are ignored.
    """
    corners = _binary(content)
    if corners is None:
        corners = _text(content)
    points = corners.reshape(-1, 3).astype(np.float64)
    faces = places(points).reshape(-1, 3)
    return MeshArrays(points, faces, groups=np.zeros(len(faces), np.int64)), ()


def _binary(content: bytes) -> np.ndarray[Any, Any] | None:
    """Return corners, (n, 3, 3); None if the file is a text."""
    start = _HEADER + _COUNT
    count = int.from_bytes(content[_HEADER:start], "little") if len(content) >= start else 0
    length = start + count * _FACET.itemsize
    if len(content) != length and _is_text(content):
        return None
    if len(content) < start:
        raise ContentError("it is neither a text nor long enough for a header")
    if len(content) < length:
        there = (len(content) - start) // _FACET.itemsize
        raise ContentError(f"it is cut off: it has {there:,} of {counted(count, 'triangle')}")
    return np.frombuffer(content, _FACET, count, start)["corners"]


def _is_text(content: bytes) -> bool:
    """Whether a file that begins with `solid` goes on as a text does."""
    head = text_of(content[:_LOOK]).lstrip().lower()
    return head.startswith("solid") and ("facet" in head or "endsolid" in head)


def _text(content: bytes) -> np.ndarray[Any, Any]:
    """Return corners, (n, 3, 3)."""
    text = text_of(content)
    found = list(_VERTEX.finditer(text))
    rows = [match[1] for match in found]
    try:
        corners = number_rows(rows, range(len(rows)), 3)
    except ValueError:
        ends = [match.start() for match in re.finditer("\n", text)]
        places = np.searchsorted(ends, [match.start() for match in found])
        corners = number_rows(rows, places.tolist(), 3)
    if len(corners) % 3:
        raise ContentError(f"its last triangle is cut off: it has {len(corners):,} corners")
    return corners.reshape(-1, 3, 3)
