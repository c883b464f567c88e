"""A fragment shader over all pixels of a picture: it reads textures and draws on others."""

from collections.abc import Mapping
from typing import Any

import moderngl

from glrt.gpu.glsl import Source
from glrt.gpu.program import drawing

_VERSION = "410 core"


class DrawnPass:
    """A fragment shader over all pixels of a texture: for resolvers."""

    def __init__(self, gl: moderngl.Context, shader: str) -> None:
        """Nothing is compiled before it is needed; `shader` is an entry file."""
        self._gl, self._shader = gl, shader
        self._program: moderngl.Program | None = None

    def draw(
        self,
        target: moderngl.Framebuffer,
        textures: Mapping[str, moderngl.Texture],
        values: Mapping[str, Any],
    ) -> None:
        """Draw over a framebuffer. Uniforms that the compiler dropped need no value."""
        program = self._program or self._compile()
        for unit, (name, texture) in enumerate(textures.items()):
            if name in program:
                texture.use(unit)
                program[name] = unit
        for name, value in values.items():
            if name in program:
                program[name] = value
        with self._gl.scope(target, moderngl.NOTHING):
            self._quad.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        """Free what the driver holds."""
        if self._program:
            self._quad.release()
            self._program.release()
        self._program = None

    def _compile(self) -> moderngl.Program:
        stages = (Source(name, version=_VERSION) for name in ("display.vert", self._shader))
        self._program = drawing(self._gl, *stages)
        self._quad = self._gl.vertex_array(self._program, [])
        return self._program
