"""How objects moved between two views: history of a surface lies where the surface was.

An object moves by the affine map between the frames that its shape has in both scenes. It may turn
and grow, too. Posed meshes have no such map: see deformed.py.
"""

from collections.abc import Iterator
from typing import NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from glrt.packing.shapes import in_order
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh

TEXELS = 7  # of a row of the table: number; three rows of the map of places, three of normals
MOST = 4096  # rows; with more objects in motion, all are taken for objects that stay

Array = NDArray[np.float64]


class Moved(NamedTuple):
    """An object that moved."""

    number: int  # in the order of the kernel
    to_before: Array  # (3, 4), from a point of it in this scene to the same point in the one before


def edited_objects(now: Scene, before: Scene) -> Iterator[tuple[int, Shape, Shape]]:
    """Yield the number of each object that is not the one of `before`, with the new and the old."""
    if now.objects is before.objects:
        return
    pairs = zip(in_order(now), in_order(before), strict=False)
    for number, (new, old) in enumerate(pairs):
        if new is not old:
            yield number, new, old


def moved_objects(now: Scene, before: Scene) -> list[Moved]:
    """Return the objects that moved since `before`, by number; no object if both differ in them."""
    maps = ((number, _map(new, old)) for number, new, old in edited_objects(now, before))
    found = [Moved(number, to_before) for number, to_before in maps if to_before is not None]
    return found if len(found) <= MOST else []


def table_of(moved: list[Moved], eye: Array, eye_before: Array) -> NDArray[np.float32]:
    """Return rows of passes/reprojection.glsl, (n, TEXELS, 4): places relative to the eyes."""
    table = np.zeros((len(moved), TEXELS, 4))
    for row, (number, to_before) in zip(table, moved, strict=True):
        linear = to_before[:, :3]
        row[0] = 1 + number
        row[1:4, :3] = linear
        row[1:4, 3] = linear @ eye + to_before[:, 3] - eye_before
        row[4:, :3] = np.linalg.inv(linear).T
    return table.astype(np.float32)


def _map(now: Shape, before: Shape) -> Array | None:
    """The map from a shape to the one before; None if it stays, or has another form."""
    if type(now) is not type(before) or _form(now) != _form(before):
        return None
    here, there = now.placement, before.placement
    if np.array_equal(here, there):
        return None
    try:
        linear = there[:, :3] @ np.linalg.inv(here[:, :3])
    except np.linalg.LinAlgError:
        return None
    found = np.column_stack([linear, there[:, 3] - linear @ here[:, 3]])
    return found if np.isfinite(found).all() and abs(np.linalg.det(linear)) > 0 else None


def _form(shape: Shape) -> object:
    return shape.form if isinstance(shape, Mesh) else None


class MotionTable:
    """The table of the objects that moved between two views, as a texture."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is allocated before something moves."""
        self._gl = gl
        self._scenes: tuple[Scene, Scene] | None = None
        self._texture: moderngl.Texture | None = None

    def between(self, now: Scene, before: Scene) -> moderngl.Texture | None:
        """The table, RGBA32F, TEXELS wide with a row for each object; None if nothing moved.

        It is valid until the next call with other scenes.
        """
        known = self._scenes
        if known and known[0] is now and known[1] is before:
            return self._texture
        self.release()
        self._scenes = now, before
        if moved := moved_objects(now, before):
            eyes = (np.array(scene.camera.position, np.float64) for scene in (now, before))
            rows = table_of(moved, *eyes)
            self._texture = self._gl.texture((TEXELS, len(rows)), 4, rows.tobytes(), dtype="f4")
        return self._texture

    def release(self) -> None:
        """Release the texture."""
        if self._texture:
            self._texture.release()
        self._texture = self._scenes = None
