"""The G-buffer: the first surface behind the middle of each pixel, to find samples again.

`shaders_glsl/integrators/middle_surface.glsl` defines its texels. A medium with a grid counts as a
surface where it has taken a tenth of the light. Texels need no sample, and are the
same in every frame of a view.
"""

from collections.abc import Mapping

import moderngl

from glrt.core.errors import RenderError
from glrt.gpu.canvas import Canvas
from glrt.gpu.context import checked
from glrt.gpu.program import tile_count
from glrt.gpu.programs import AnyKernel
from glrt.rendering.history.deformed import DeformedPass
from glrt.rendering.history.drawn_pass import DrawnPass
from glrt.rendering.history.motion import MotionTable
from glrt.rendering.kernel_switch import taken
from glrt.rendering.pass_film import Size
from glrt.rendering.passes import SURFACES
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import DispatchRange, whole_frame
from glrt.scene.scene import Scene
from glrt.settings import Settings


class Surfaces:
    """The G-buffer of a view: two RGBA32F textures, row 0 on top, with its scene and settings.

    `position`: relative to the eye in scene units, and 1 + the number of the object; where nothing
    is met, a unit direction and 0. `normal`: unit, towards the eye, and flags as bits.
    """

    samples = next_sample = 0  # required of whatever a kernel fills

    def __init__(self, gl: moderngl.Context) -> None:
        """Begin empty, without a view."""
        self._gl = gl
        self._textures: dict[str, moderngl.Texture] = {}
        self._size_of: moderngl.Texture | None = None
        self.marked = Canvas(gl, "f4")
        self.motion, self.deformed = MotionTable(gl), DeformedPass(gl)
        self.scene: Scene | None = None
        self.settings: Settings | None = None

    @property
    def position(self) -> moderngl.Texture:
        """Positions of the surfaces relative to the eye, and 1 + the numbers of their objects."""
        return self._textures["position"]

    @property
    def normal(self) -> moderngl.Texture:
        """Normals of the surfaces towards the eye, and flags with edges marked."""
        assert self.marked.texture
        return self.marked.texture

    @property
    def unmarked(self) -> dict[str, moderngl.Texture]:
        """Both textures before edges are marked, by the sampler names of edges.frag."""
        return self._textures

    @property
    def size(self) -> Size:
        """Width and height in pixels; (0, 0) while empty."""
        return self.position.size if self._textures else (0, 0)

    def begin(self, renderer: Renderer) -> None:
        """Adopt a renderer's scene, settings and size; RenderError if the driver has no room."""
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

    def leave(self) -> None:
        """Discard the view; the textures stay for the next one."""
        self.scene = self.settings = self._size_of = None

    def images(self) -> Mapping[str, moderngl.Texture]:
        """The textures by the names of the kernel's image uniforms."""
        assert self._size_of
        targets = {f"target_{name}": texture for name, texture in self._textures.items()}
        return {"source_mean": self._size_of, **targets}

    def release(self) -> None:
        """Release the textures; the G-buffer is empty again."""
        self._free()
        self.motion.release()
        self.deformed.release()
        self.leave()

    def _free(self) -> None:
        for texture in self._textures.values():
            texture.release()
        self._textures = {}
        self.marked.release()


class SurfacePass:
    """Fills a G-buffer from the scene of a renderer, with one camera ray per pixel."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled before it is needed."""
        self._edges = DrawnPass(gl, "edges.frag")

    def fill(self, renderer: Renderer, surfaces: Surfaces) -> None:
        """Find the surfaces of the view that a renderer shows.

        Raises RenderError if the driver refuses the kernel or has no room.
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
        """Release all OpenGL resources."""
        self._edges.release()
