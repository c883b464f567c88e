"""Where normals that are interpolated over triangles round sharp edges off."""

import math

import numpy as np
from numpy.typing import NDArray

from glrt.scene.meshes.vertex_means import PORTION

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SHARPEST = 40.0  # degrees: an icosahedron that stands for a ball has 37, the rim of a cylinder 45


def rounded_share(vertices: Floats, faces: Ints, normals: Floats) -> float:
    """Return the share of the area of triangles with a corner whose normal is far off, 0 to 1.

    Far is more than SHARPEST degrees from the normal of the triangle. Vertices and unit normals
    are (v, 3), numbers of vertices (n, 3).
    """
    whole = rounded = 0.0
    for first in range(0, len(faces), PORTION):
        some = faces[first : first + PORTION]
        corners = vertices[some]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(across, axis=1)
        along = (normals[some] * across[:, None]).sum(axis=2).min(axis=1)
        is_far = along < math.cos(math.radians(SHARPEST)) * area
        whole, rounded = whole + area.sum(), rounded + area[is_far].sum()
    return float(rounded / whole) if whole else 0.0
