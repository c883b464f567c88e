"""The line around all that meshes cover in the picture, drawn from their triangles."""

from collections.abc import Sequence
from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from glrt.gpu.canvas import Canvas
from glrt.gpu.glsl import Source
from glrt.gpu.program import drawing
from glrt.packing.scene_arrays import pack_camera
from glrt.rendering.history.drawn_pass import DrawnPass
from glrt.scene.camera import Camera
from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.shapes.mesh import Mesh
from glrt.view.state.zoom import Rectangle

Array = NDArray[np.float64]

_VERSION = "410 core"
WIDTH = 1.5  # pixels of the bright line


@dataclass(frozen=True)
class _Corners:
    """Corners of triangles on the driver, relative to their middle."""

    of: TriangleMesh
    buffer: moderngl.Buffer
    triangles: moderngl.VertexArray

    def release(self) -> None:
        self.triangles.release()
        self.buffer.release()


class Silhouette:
    """Draws one line around meshes; the corners of the last ones stay on the driver."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Compile and allocate nothing before it is needed."""
        self._gl = gl
        self._mask, self._line = Canvas(gl), Canvas(gl)
        self._around = DrawnPass(gl, "silhouette_line.frag")
        self._program: moderngl.Program | None = None
        self._kept: list[_Corners] = []
        self._drawn: bytes = b""

    def draw(
        self, meshes: Sequence[Mesh], camera: Camera, place: Rectangle, seen: Rectangle
    ) -> moderngl.Texture:
        """Draw the line over the part `seen` of a picture at `place`, rectangles on the screen.

        Where meshes overlap in the picture, the line is around all of them. The texture is valid
        until the next call; its row 0 is the lowest.
        """
        self._take([mesh.triangles for mesh in meshes])
        size = max(round(seen[2]), 1), max(round(seen[3]), 1)
        onto = to_part(camera, place, seen)
        matrices = [onto @ _to_scene(mesh, _middle(mesh.triangles)) for mesh in meshes]
        content = np.array([matrix.T for matrix in matrices], np.float32)
        if (wanted := content.tobytes() + bytes(np.array(size))) != self._drawn:
            self._redraw(meshes, content, size)
            self._drawn = wanted
        assert self._line.texture
        return self._line.texture

    def release(self) -> None:
        """Release all OpenGL resources."""
        self._take([])
        self._mask.release()
        self._line.release()
        self._around.release()
        if self._program:
            self._program.release()
        self._program = None

    def _redraw(
        self, meshes: Sequence[Mesh], matrices: NDArray[np.float32], size: tuple[int, int]
    ) -> None:
        mask = self._mask.sized(size)
        assert self._program
        with self._gl.scope(mask, moderngl.NOTHING):
            mask.clear()
            for mesh, matrix in zip(meshes, matrices, strict=True):
                self._program["to_part"] = tuple(matrix.ravel().tolist())
                self._of(mesh.triangles).triangles.render(moderngl.TRIANGLES)
        assert self._mask.texture
        textures = {"mask": self._mask.texture}
        self._around.draw(self._line.sized(size), textures, {"width": WIDTH})

    def _of(self, triangles: TriangleMesh) -> _Corners:
        return next(corners for corners in self._kept if corners.of is triangles)

    def _take(self, wanted: Sequence[TriangleMesh]) -> None:
        """Write the corners of triangles to the driver where they are not; release all others."""
        for corners in self._kept:
            if not _holds(wanted, corners.of):
                corners.release()
                self._drawn = b""
        self._kept = [corners for corners in self._kept if _holds(wanted, corners.of)]
        for triangles in wanted:
            if not _holds([corners.of for corners in self._kept], triangles):
                self._kept.append(self._written(triangles))

    def _written(self, triangles: TriangleMesh) -> _Corners:
        if not self._program:
            stages = (Source(f"silhouette.{kind}", version=_VERSION) for kind in ("vert", "frag"))
            self._program = drawing(self._gl, *stages)
        vertices = np.asarray(triangles.vertices - _middle(triangles), np.float32)
        buffer = self._gl.buffer(vertices[triangles.faces].tobytes())
        return _Corners(triangles, buffer, self._gl.vertex_array(self._program, buffer, "corner"))


def _holds(meshes: Sequence[TriangleMesh], mesh: TriangleMesh) -> bool:
    return any(one is mesh for one in meshes)


def _middle(triangles: TriangleMesh) -> Array:
    low, high = triangles.box
    return np.asarray((low + high) / 2, np.float64)


def _to_scene(mesh: Mesh, middle: Array) -> Array:
    """Return the matrix from places about `middle`, in file coordinates, to the scene."""
    matrix = np.eye(4)
    matrix[:3, :3] = mesh.linear
    matrix[:3, 3] = mesh.linear @ middle + mesh.origin
    return matrix


def to_part(camera: Camera, place: Rectangle, seen: Rectangle) -> Array:
    """Return the matrix from the scene to clip coordinates of the part `seen` of a picture."""
    packed = pack_camera(camera, place[2] / place[3])
    frame = {name: np.asarray(value, np.float64) for name, value in packed.items()}
    axes = np.stack([frame[name] for name in ("right", "up", "forward")])
    view = np.eye(4)
    view[:3, :3] = axes
    view[:3, 3] = -axes @ np.array(camera.position)
    across, down = place[2] / seen[2], place[3] / seen[3]
    aside = (2 * (place[0] - seen[0]) + place[2]) / seen[2] - 1
    above = 1 - (2 * (place[1] - seen[1]) + place[3]) / seen[3]
    onto: Array = np.zeros((4, 4))  # depth 0 for all: OpenGL cuts what lies behind the camera
    onto[0, 0], onto[0, 2] = across / float(frame["tan_x"]), aside
    onto[1, 1], onto[1, 2] = down / float(frame["tan_y"]), above
    onto[3, 2] = 1.0
    return onto @ view
