"""The first surface under simple light: two AOVs as one picture, drawn on any framebuffer.

It has hardly any noise, while a few samples of a scene's light are hardly anything else.
"""

import moderngl

from glrt.gpu.glsl import Source
from glrt.gpu.program import drawing
from glrt.packing.scene_arrays import screen_axes
from glrt.scene.camera import Camera
from glrt.settings import Aov

_VERSION = "410 core"
NEEDED: tuple[Aov, Aov] = ("albedo", "normal")


class SurfaceView:
    """Draws albedo, shaded by the normal, on the framebuffer in use."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled before it is needed."""
        self._gl = gl
        self._program: moderngl.Program | None = None

    def draw(self, albedo: moderngl.Texture, normal: moderngl.Texture, camera: Camera) -> None:
        """Draw the means of both AOVs, as sRGB; pixels that meet nothing are grey."""
        program = self._program or self._compile()
        width, height = albedo.size
        for number, (name, mean) in enumerate((("albedo", albedo), ("normal", normal))):
            mean.use(number)
            program[name] = number
        for name, value in screen_axes(camera, width / height).items():
            program[name] = value
        self._quad.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        """Release program and quad."""
        if self._program:
            self._quad.release()
            self._program.release()

    def _compile(self) -> moderngl.Program:
        stages = (Source(name, version=_VERSION) for name in ("display.vert", "first_surface.frag"))
        self._program = drawing(self._gl, *stages)
        self._quad = self._gl.vertex_array(self._program, [])
        return self._program
