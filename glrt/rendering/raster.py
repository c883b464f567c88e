"""First surfaces by rasterisation, for one sample of each pixel at a time."""

from contextlib import ExitStack
from typing import Any

import moderngl
import numpy as np

from glrt.gpu.context import Context
from glrt.gpu.depth_texture import depth_texture
from glrt.gpu.glsl import read
from glrt.gpu.program import Resource
from glrt.gpu.raster_kernel import Draw, RasterKernel
from glrt.gpu.structs import read_constants
from glrt.plan.plan import Plan
from glrt.rendering.device_scene import DeviceScene, Exposed
from glrt.rendering.schedule import DispatchRange

HITS, ORDER = "raster_hits", "raster_order"  # textures: first surfaces, triangles to draw
PARTS = read_constants(read("raster.glsl"))
WIDTH = 1 << 12  # triangles along a row of ORDER


class Raster:
    """The first surface behind each pixel, for the ray of one of its samples.

    A texture holds the number of its shape and the bits of its distance, row 0 on top. It is what
    the tracer finds, to the bit: fragments solve the same intersections. A plan whose method traces
    its first rays has none.
    """

    def __init__(self, context: Context, plan: Plan, scene: DeviceScene) -> None:
        """Compile the program and allocate its target; RenderError if the driver refuses."""
        self._plan, self._scene = plan, scene
        self._known: tuple[int, int] | None = None  # samples of the film, and the next one
        self._kernel: RasterKernel | None = None
        self._held = ExitStack()
        if plan.needs.rasters:
            with ExitStack() as held:
                self._open(context, held)
                self._held = held.pop_all()

    def _open(self, context: Context, held: ExitStack) -> None:
        gl, size, rows = context.gl, self._plan.settings.size, self._scene.drawn_triangles
        with context.checked(f"a raster of {size[0]} x {size[1]} pixels"):
            self._hits = gl.texture(size, 2, dtype="i4")
            held.callback(self._hits.release)
            self._hits.filter = moderngl.NEAREST, moderngl.NEAREST  # integers are not interpolated
            depth = depth_texture(gl, size)
            held.callback(depth.release)
            self._target = gl.framebuffer([self._hits], depth)
            held.callback(self._target.release)
            self._order = _order_texture(gl, rows)
            held.callback(self._order.release)
        counts = {"BACKDROP": 1, "PROXIES": self._scene.proxies, "FACES": len(rows)}
        self._draws = tuple(Draw(PARTS[name], times) for name, times in counts.items())
        sources = self._scene.raster_sources()
        kernel = context.programs.take(sources, lambda: RasterKernel(gl, *sources))
        held.callback(context.programs.give_back, kernel)
        assert isinstance(kernel, RasterKernel)
        self._kernel = kernel

    def at_once(self, samples: int) -> int:
        """How many of `samples` one dispatch can add: a raster holds the surfaces of one."""
        return 1 if self._kernel else samples

    def drawn(self, film: Exposed, samples: int) -> dict[str, Resource]:
        """Draw the next sample of a film unless that is done; return what kernels read.

        With 0 `samples` nothing is drawn.
        """
        if not self._kernel:
            return {}
        wanted = film.samples, film.next_sample
        if samples and self._known != wanted:
            self._kernel.target, self._kernel.draws = self._target, self._draws
            part, own = DispatchRange(1, 0, 1), {ORDER: self._order}
            self._scene.dispatch(self._kernel, film, self._plan, part, 1, own)
            self._known = wanted
        return {HITS: self._hits}

    def release(self) -> None:
        """Release all OpenGL resources, and give the program back."""
        self._held.close()


def _order_texture(gl: moderngl.Context, rows: np.ndarray[Any, Any]) -> moderngl.Texture:
    """Return a texture of `drawn_triangles`, at least one row high."""
    height = max(1, -(-len(rows) // WIDTH))
    padded = np.zeros((height * WIDTH, 2), np.int32)
    padded[: len(rows)] = rows
    texture = gl.texture((WIDTH, height), 2, padded.tobytes(), dtype="i4")
    texture.filter = moderngl.NEAREST, moderngl.NEAREST
    return texture
