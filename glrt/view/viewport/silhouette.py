"""The line around all that a mesh covers in the picture, drawn from its triangles."""

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


class Silhouette:
    """Draws the line around one mesh; the corners of the last mesh stay on the driver."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Compile and allocate nothing before it is needed."""
        self._gl = gl
        self._mask, self._line = Canvas(gl), Canvas(gl)
        self._around = DrawnPass(gl, "silhouette_line.frag")
        self._program: moderngl.Program | None = None
        self._of: TriangleMesh | None = None
        self._triangles: moderngl.VertexArray | None = None
        self._corners: moderngl.Buffer | None = None
        self._drawn: bytes = b""

    def draw(
        self, mesh: Mesh, camera: Camera, place: Rectangle, seen: Rectangle
    ) -> moderngl.Texture:
        """Draw the line over the part `seen` of a picture at `place`, rectangles on the screen.

        The texture is valid until the next call; its row 0 is the lowest.
        """
        triangles = mesh.triangles
        if triangles is not self._of:
            self._take(triangles)
        size = max(round(seen[2]), 1), max(round(seen[3]), 1)
        matrix = to_part(camera, place, seen) @ _to_scene(mesh, _middle(triangles))
        content = np.ascontiguousarray(matrix.T, np.float32).tobytes()
        if (wanted := content + bytes(np.array(size))) != self._drawn:
            self._redraw(content, size)
            self._drawn = wanted
        assert self._line.texture
        return self._line.texture

    def release(self) -> None:
        """Release all OpenGL resources."""
        self._forget()
        self._mask.release()
        self._line.release()
        self._around.release()
        if self._program:
            self._program.release()
        self._program = None

    def _redraw(self, matrix: bytes, size: tuple[int, int]) -> None:
        mask = self._mask.sized(size)
        assert self._program
        assert self._triangles
        self._program["to_part"] = tuple(np.frombuffer(matrix, np.float32).tolist())
        with self._gl.scope(mask, moderngl.NOTHING):
            mask.clear()
            self._triangles.render(moderngl.TRIANGLES)
        assert self._mask.texture
        textures = {"mask": self._mask.texture}
        self._around.draw(self._line.sized(size), textures, {"width": WIDTH})

    def _take(self, triangles: TriangleMesh) -> None:
        """Write the corners of triangles to the driver, relative to their middle."""
        self._forget()
        if not self._program:
            stages = (Source(f"silhouette.{kind}", version=_VERSION) for kind in ("vert", "frag"))
            self._program = drawing(self._gl, *stages)
        vertices = np.asarray(triangles.vertices - _middle(triangles), np.float32)
        self._corners = self._gl.buffer(vertices[triangles.faces].tobytes())
        self._triangles = self._gl.vertex_array(self._program, self._corners, "corner")
        self._of = triangles

    def _forget(self) -> None:
        for resource in (self._triangles, self._corners):
            if resource:
                resource.release()
        self._of = self._triangles = self._corners = None
        self._drawn = b""


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
