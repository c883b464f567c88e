"""A fragment shader over all pixels of a picture: it reads textures and draws on others."""

from collections.abc import Mapping, Sequence
from typing import Any

import moderngl

from glrt.gpu.glsl import Source
from glrt.gpu.program import drawing

_VERSION = "410 core"
Textures = Mapping[str, moderngl.Texture | Sequence[moderngl.Texture]]  # by sampler, or samplers


class DrawnPass:
    """A fragment shader that draws over all pixels of a framebuffer."""

    def __init__(self, gl: moderngl.Context, shader: str) -> None:
        """Nothing is compiled before it is needed; `shader` is an entry file."""
        self._gl, self._shader = gl, shader
        self._program: moderngl.Program | None = None

    def draw(
        self,
        target: moderngl.Framebuffer,
        textures: Textures,
        values: Mapping[str, Any],
    ) -> None:
        """Draw over `target`; values for uniforms that the compiler dropped are ignored."""
        program = self._program or self._compile()
        unit = 0
        for name, given in textures.items():
            if name not in program:
                continue
            parts = [given] if isinstance(given, moderngl.Texture) else [*given]
            for place, texture in enumerate(parts, unit):
                texture.use(place)
            places = [*range(unit, unit + len(parts))]
            program[name] = places[0] if isinstance(given, moderngl.Texture) else places
            unit += len(parts)
        for name, value in values.items():
            if name in program:
                program[name] = value
        with self._gl.scope(target, moderngl.NOTHING):
            self._quad.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        """Release all OpenGL resources."""
        if self._program:
            self._quad.release()
            self._program.release()
        self._program = None

    def _compile(self) -> moderngl.Program:
        stages = (Source(name, version=_VERSION) for name in ("display.vert", self._shader))
        self._program = drawing(self._gl, *stages)
        self._quad = self._gl.vertex_array(self._program, [])
        return self._program
