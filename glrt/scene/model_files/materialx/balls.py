"""A ball for each material, next to and above one another, and a camera that sees all of them."""

import math

import numpy as np
from numpy.typing import NDArray

from glrt.scene.model_files.gltf_file import GltfFile, Table

_AROUND, _ALONG = 96, 48  # faces of a ball, around and from pole to pole
_STEP = 2.4  # from ball to ball, of radius 1
_FOV = 0.35  # radians: height of the picture
_ROOM = 1.15  # of the picture around the balls
_ABOVE = 0.25  # radians: how far the camera looks down
_SEAM = 3 * _AROUND // 4  # column of the seam of the texture, behind the ball

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


def ball() -> tuple[Floats, Floats, Ints]:
    """Return points, (v, 3), texture coordinates with v downwards, (v, 2), and triangles, (n, 3).

    The ball is closed to the bit: both ends of its seam have the same points.
    """
    column, row = np.meshgrid(np.arange(_AROUND + 1), np.arange(_ALONG + 1))
    turn = 2 * math.pi * ((column + _SEAM) % _AROUND) / _AROUND
    radius = np.where(row % _ALONG == 0, 0.0, np.sin(math.pi * row / _ALONG))
    points = np.stack(
        [-radius * np.cos(turn), np.cos(math.pi * row / _ALONG), radius * np.sin(turn)], axis=-1
    )
    uv = np.stack([column / _AROUND, row / _ALONG], axis=-1)
    number = np.arange(points[..., 0].size).reshape(row.shape)
    upper, lower = number[:-1, :-1], number[1:, :-1]
    right, last = number[:-1, 1:], number[1:, 1:]
    first = np.stack([upper, lower, last], axis=-1)[:-1].reshape(-1, 3)  # all but the south pole
    second = np.stack([upper, last, right], axis=-1)[1:].reshape(-1, 3)  # all but the north pole
    return points.reshape(-1, 3), uv.reshape(-1, 2), np.concatenate([first, second])


def add_balls(glb: GltfFile, names: list[str]) -> None:
    """Add materials by their names, a ball of each, and a camera."""
    points, uv, triangles = ball()
    places = glb.vertices(uv)
    attributes = {"POSITION": glb.vertices(points), "NORMAL": glb.vertices(points)}
    attributes |= {"TEXCOORD_0": places, "TEXCOORD_1": places}
    corners = glb.corners(triangles)
    wide = math.ceil(math.sqrt(len(names)))
    tall = math.ceil(len(names) / wide)
    for number, name in enumerate(names):
        row, column = divmod(number, wide)
        here = min(wide, len(names) - row * wide)  # balls of this row
        across = _STEP * (column - (here - 1) / 2)
        look: Table = {"attributes": attributes, "indices": corners, "material": number}
        glb.add("materials", {"name": name})
        mesh = glb.add("meshes", {"primitives": [look]})
        height = _STEP * (tall - 1 - row)
        glb.add("nodes", {"name": name, "mesh": mesh, "translation": [across, height, 0.0]})
    _add_camera(glb, wide, tall)
    glb.add("scenes", {"nodes": list(range(len(names) + 1))})


def _add_camera(glb: GltfFile, wide: int, tall: int) -> None:
    width, height = (2 + _STEP * (count - 1) for count in (wide, tall))
    aspect = width / height
    away = max(height, width / aspect) * _ROOM / 2 / math.sin(_FOV / 2) + 1
    middle = _STEP * (tall - 1) / 2
    perspective = {"yfov": _FOV, "aspectRatio": aspect, "znear": 0.1}
    camera = glb.add("cameras", {"type": "perspective", "perspective": perspective})
    position = [0.0, middle + away * math.sin(_ABOVE), away * math.cos(_ABOVE)]
    turn = [-math.sin(_ABOVE / 2), 0.0, 0.0, math.cos(_ABOVE / 2)]
    glb.add("nodes", {"camera": camera, "translation": position, "rotation": turn})
