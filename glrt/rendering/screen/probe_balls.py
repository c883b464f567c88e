"""Draw probes as balls over a picture, to show what each holds and where light leaks."""

import moderngl
import numpy as np

from glrt.gpu.canvas import Canvas
from glrt.gpu.glsl import Source
from glrt.gpu.program import drawing
from glrt.packing.probes import probe_fields
from glrt.packing.scene_arrays import screen_axes
from glrt.plan.probe_grid import Grid
from glrt.rendering.probe_tracer import ProbeTracer
from glrt.scene.camera import Camera

RADIUS = 0.1  # of a ball, in shortest edges of a cell
FARTHEST = 1.5  # of a cell's diagonal: the maps hold no larger distance (probes/blend.glsl)
_VERSION = "410 core"


def farthest(grid: Grid) -> float:
    """The largest distance that probes hold, in scene units."""
    return FARTHEST * float(np.linalg.norm(grid.cell))


class ProbeBalls:
    """Draws a ball for each useful probe, with its light and its distances by direction."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled before it is needed."""
        self._gl, self._canvas = gl, Canvas(gl, "f4")
        self._program: moderngl.Program | None = None
        self._order: moderngl.Buffer | None = None
        self._squares: moderngl.VertexArray | None = None

    def draw(
        self,
        light: moderngl.Texture,
        depth: moderngl.Texture,
        probes: ProbeTracer,
        camera: Camera,
    ) -> moderngl.Texture:
        """Draw balls over the radiance `light` of a picture, where its AOV `depth` is not nearer.

        Returns RGBA32F, valid until the next call; a: mean distance in scene units, below 0 outside
        balls. On a ball, radiance is irradiance / pi by its normal.
        """
        program = self._program or self._compile()
        width, height = light.size
        textures = {"light": light, "depth": depth, **probes.maps}
        for unit, (name, texture) in enumerate(textures.items()):
            texture.use(unit)
            program[name] = unit
        for name, axis in screen_axes(camera, width / height).items():
            program[name] = axis
        fields = probe_fields(probes.grid, camera)
        for name in ("probe_first", "probe_cell", "probe_counts"):
            program[f"frame.{name}"] = tuple(np.asarray(fields[name]).tolist())
        program["radius"] = RADIUS * float(probes.grid.cell.min())
        squares = self._squares_of(probes.grid, camera, program)
        with self._gl.scope(self._canvas.sized(light.size), moderngl.NOTHING):
            squares.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=1 + probes.grid.probes)
        assert self._canvas.texture
        return self._canvas.texture

    def release(self) -> None:
        """Release all OpenGL resources."""
        self._canvas.release()
        for part in (self._squares, self._order, self._program):
            if part:
                part.release()
        self._program = self._order = self._squares = None

    def _squares_of(
        self, grid: Grid, camera: Camera, program: moderngl.Program
    ) -> moderngl.VertexArray:
        """Vertices of the picture, then of the balls, far ones first: near ones hide them."""
        away = np.linalg.norm(grid.places() - np.array(camera.position, np.float64), axis=1)
        order = np.concatenate([[-1], np.argsort(-away)]).astype(np.int32)
        if self._order and self._order.size == order.nbytes:
            self._order.write(order.tobytes())
        else:
            for part in (self._squares, self._order):
                if part:
                    part.release()
            self._order = self._gl.buffer(order.tobytes())
            self._squares = self._gl.vertex_array(program, [(self._order, "1i/i", "number")])
        assert self._squares
        return self._squares

    def _compile(self) -> moderngl.Program:
        vertex, fragment = (
            Source(f"probe_balls.{stage}", version=_VERSION) for stage in ("vert", "frag")
        )
        self._program = drawing(self._gl, vertex, fragment)
        return self._program
