"""Where surfaces of posed meshes were before: their triangles are drawn over the G-buffer.

A skinned or morphed mesh has no map of its own from one view to another. Each of its triangles has
one: the same share of its corners is the same point.
"""

from typing import NamedTuple

import moderngl
import numpy as np
from numpy.typing import NDArray

from glrt.gpu.canvas import Canvas
from glrt.gpu.glsl import Source
from glrt.gpu.program import drawing
from glrt.packing.scene_arrays import screen_axes
from glrt.rendering.history.motion import edited_objects
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.settings import Settings

_VERSION = "410 core"

Array = NDArray[np.float64]


class Deformed(NamedTuple):
    """The triangles of an object whose shape changed."""

    number: int  # of the object, in the order of the kernel
    now: Array  # (n, 3, 3): corners in the scene
    before: Array  # (n, 3, 3): the same corners in the scene before


class View(NamedTuple):
    """A G-buffer with all that is needed to draw over it."""

    scene: Scene
    settings: Settings
    position: moderngl.Texture
    normal: moderngl.Texture


def deformed_objects(now: Scene, before: Scene) -> list[Deformed]:
    """Return the meshes that have another pose than in `before`, with the triangles that moved."""
    found = list[Deformed]()
    for number, new, old in edited_objects(now, before):
        if not isinstance(new, Mesh) or not isinstance(old, Mesh) or not _is_other_pose(new, old):
            continue
        here, there = (mesh.world_vertices[mesh.triangles.faces] for mesh in (new, old))
        if here.shape == there.shape:
            has_moved = (here != there).any(axis=(1, 2))
            found.append(Deformed(number, here[has_moved], there[has_moved]))
    return [it for it in found if len(it.now)]


def _is_other_pose(new: Mesh, old: Mesh) -> bool:
    """Whether two meshes show the same triangles in different poses."""
    same = new.file.sha256 == old.file.sha256 and (new.part, new.variant) == (old.part, old.variant)
    return same and (new.animation, new.time) != (old.animation, old.time)


class DeformedPass:
    """Draws what deformed objects were, over a G-buffer."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Compile and allocate nothing before something is deformed."""
        self._gl = gl
        self._canvas = Canvas(gl, "f4", 2)
        self._program: moderngl.Program | None = None
        self._known: tuple[View, Scene] | None = None

    def between(self, view: View, before: Scene) -> list[moderngl.Texture]:
        """Return places and normals before (shaders_glsl/deformed.frag); nothing if all is stiff.

        The textures are valid until the next call with another view.
        """
        known = self._known
        if known is None or known[1] is not before or not _is_same(known[0], view):
            self._known = view, before
            if objects := deformed_objects(view.scene, before):
                self._draw(objects, view, before)
            else:
                self._canvas.release()
        return self._canvas.textures

    def release(self) -> None:
        """Release all OpenGL resources."""
        self._canvas.release()
        if self._program:
            self._program.release()
        self._program = self._known = None

    def _draw(self, objects: list[Deformed], view: View, before: Scene) -> None:
        if not self._program:
            stages = (Source(f"deformed.{kind}", version=_VERSION) for kind in ("vert", "frag"))
            self._program = drawing(self._gl, *stages)
        eyes = [np.array(scene.camera.position, np.float64) for scene in (view.scene, before)]
        settings, program = view.settings, self._program
        values = {
            **screen_axes(view.scene.camera, settings.width / settings.height),
            "frame": (float(settings.width), float(settings.height)),
            "origin": tuple(map(float, settings.crop[:2] if settings.crop else (0, 0))),
            "size": tuple(map(float, view.position.size)),
            "position": 0,
            "normal": 1,
        }
        for name, value in values.items():
            program[name] = value
        view.position.use(0)
        view.normal.use(1)
        target = self._canvas.sized(view.position.size)
        with self._gl.scope(target, moderngl.NOTHING):
            target.clear()
            for number, now, then in objects:
                program["object"] = float(1 + number)
                self._draw_triangles(program, np.concatenate([now - eyes[0], then - eyes[1]], 2))

    def _draw_triangles(self, program: moderngl.Program, corners: Array) -> None:
        """Draw triangles, (n, 3, 6): corners and corners before, relative to the eyes."""
        buffer = self._gl.buffer(corners.astype(np.float32).tobytes())
        try:
            array = self._gl.vertex_array(program, buffer, "corner", "corner_before")
            array.render(moderngl.TRIANGLES)
            array.release()
        finally:
            buffer.release()


def _is_same(one: View, other: View) -> bool:
    return all(first is second for first, second in zip(one, other, strict=True))
