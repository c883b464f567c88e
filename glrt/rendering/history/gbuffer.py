"""The first surface behind the middle of each pixel (a G-buffer), by which samples are found again.

`shaders_glsl/integrators/middle_surface.glsl` says what its texels hold: they need no sample, and
are the same in every frame of a view.
"""

from collections.abc import Mapping

import moderngl

from glrt.core.errors import RenderError
from glrt.gpu.canvas import Canvas
from glrt.gpu.context import checked
from glrt.gpu.program import tile_count
from glrt.gpu.programs import AnyKernel
from glrt.rendering.history.drawn_pass import DrawnPass
from glrt.rendering.kernel_switch import taken
from glrt.rendering.pass_film import Size
from glrt.rendering.passes import SURFACES
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import DispatchRange, whole_frame
from glrt.scene.scene import Scene
from glrt.settings import Settings


class Surfaces:
    """Two RGBA32F textures of a view, row 0 on top, and the scene and settings that they are of.

    `position`: relative to the eye in scene units, and 1 + the number of the object; where nothing
    is met a unit direction and 0. `normal`: unit, towards the eye, and flags as bits.
    """

    samples = next_sample = 0  # as a kernel asks of what it fills

    def __init__(self, gl: moderngl.Context) -> None:
        """Empty: of no view."""
        self._gl = gl
        self._textures: dict[str, moderngl.Texture] = {}
        self._size_of: moderngl.Texture | None = None
        self.marked = Canvas(gl, "f4")
        self.scene: Scene | None = None
        self.settings: Settings | None = None

    @property
    def position(self) -> moderngl.Texture:
        """Where the surfaces are, and of which objects."""
        return self._textures["position"]

    @property
    def normal(self) -> moderngl.Texture:
        """How they face, and flags."""
        assert self.marked.texture
        return self.marked.texture

    @property
    def unmarked(self) -> dict[str, moderngl.Texture]:
        """The same before edges are marked, by the names of edges.frag."""
        return self._textures

    @property
    def size(self) -> Size:
        """Width and height in pixels; (0, 0) while empty."""
        return self.position.size if self._textures else (0, 0)

    def begin(self, renderer: Renderer) -> None:
        """Take the size of a renderer's picture; RenderError if the driver has no room for that."""
        self._size_of = renderer.film.mean
        self.scene, self.settings = renderer.scene, renderer.settings
        if self.size == renderer.size:
            return
        self._free()
        what = f"surfaces of {renderer.size[0]} x {renderer.size[1]} pixels"
        try:
            with checked(self._gl, what):
                for name in SURFACES.outputs:
                    self._textures[name] = self._gl.texture(renderer.size, 4, dtype="f4")
        except RenderError:
            self.release()
            raise

    def images(self) -> Mapping[str, moderngl.Texture]:
        """The textures under the names of the kernel's images."""
        assert self._size_of
        targets = {f"target_{name}": texture for name, texture in self._textures.items()}
        return {"source_mean": self._size_of, **targets}

    def release(self) -> None:
        """Free the textures: of no view again."""
        self._free()
        self.scene = self.settings = self._size_of = None

    def _free(self) -> None:
        for texture in self._textures.values():
            texture.release()
        self._textures = {}
        self.marked.release()


class SurfacePass:
    """Fills surfaces by the scene of a renderer; a camera ray for each pixel."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled before it is needed."""
        self._edges = DrawnPass(gl, "edges.frag")

    def fill(self, renderer: Renderer, surfaces: Surfaces) -> None:
        """Find the surfaces of the view that a renderer shows.

        RenderError if the driver refuses the kernel or has no room.
        """
        scene, tiles = renderer.device_scene, tile_count(*renderer.size)

        def dispatch(kernel: AnyKernel, part: DispatchRange) -> None:
            scene.dispatch(kernel, surfaces, renderer.plan, part, tiles)

        with renderer.context.gl:
            surfaces.begin(renderer)
            with taken(renderer.context, scene.shaders_of(SURFACES), dispatch) as kernel:
                for part in whole_frame(1, tiles):
                    dispatch(kernel, part)
            target = surfaces.marked.sized(surfaces.size)
            self._edges.draw(target, surfaces.unmarked, {})

    def release(self) -> None:
        """Free what the driver holds."""
        self._edges.release()
