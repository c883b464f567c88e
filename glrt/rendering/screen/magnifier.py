"""Enlarge a part of a picture with sharp pixels, since Dear ImGui smooths its textures."""

import moderngl

from glrt.gpu.canvas import Canvas
from glrt.gpu.glsl import Source
from glrt.gpu.program import drawing

_VERSION = "410 core"


class Magnifier:
    """Draws parts of textures, enlarged, into a texture of its own."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Nothing is compiled before it is needed."""
        self._gl = gl
        self._program: moderngl.Program | None = None
        self._canvas = Canvas(gl)

    def draw(
        self,
        picture: moderngl.Texture,
        part: tuple[float, float, float, float],
        size: tuple[int, int],
    ) -> moderngl.Texture:
        """Draw a part (left, top, width, height in pixels, from the upper left) on `size` pixels.

        The returned texture is valid until the next call; its row 0 is the lowest.
        """
        program = self._program or self._compile()
        picture.use(0)
        program["picture"] = 0
        program["corner"], program["extent"] = part[:2], part[2:]
        with self._gl.scope(self._canvas.sized(size)):
            self._quad.render(moderngl.TRIANGLE_STRIP, vertices=4)
        assert self._canvas.texture
        return self._canvas.texture

    def release(self) -> None:
        """Release all OpenGL resources."""
        self._canvas.release()
        if self._program:
            self._quad.release()
            self._program.release()

    def _compile(self) -> moderngl.Program:
        stages = (Source(name, version=_VERSION) for name in ("display.vert", "magnify.frag"))
        self._program = drawing(self._gl, *stages)
        self._quad = self._gl.vertex_array(self._program, [])
        return self._program
