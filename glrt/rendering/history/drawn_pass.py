"""A fragment shader over all pixels of a picture: it reads textures and draws on others."""

from collections.abc import Mapping, Sequence
from typing import Any

import moderngl

from glrt.gpu.glsl import Source
from glrt.gpu.program import drawing

_VERSION = "410 core"
Textures = Mapping[str, moderngl.Texture | Sequence[moderngl.Texture]]  # by sampler, or samplers


class DrawnPass:
    """A fragment shader that draws over all pixels of a framebuffer.

    Constants of the shader are either true or false; it is compiled for the values that are drawn.
    """

    def __init__(self, gl: moderngl.Context, shader: str, constants: Sequence[str] = ()) -> None:
        """Nothing is compiled before it is needed; `shader` is an entry file."""
        self._gl, self._shader, self._constants = gl, shader, constants
        self._programs: dict[tuple[bool, ...], tuple[moderngl.Program, moderngl.VertexArray]] = {}

    def draw(
        self,
        target: moderngl.Framebuffer,
        textures: Textures,
        values: Mapping[str, Any],
    ) -> None:
        """Draw over `target`, by values of uniforms and constants.

        Those of uniforms that the compiler dropped are ignored.
        """
        chosen = tuple(bool(values[name]) for name in self._constants)
        program, quad = self._programs.get(chosen) or self._compile(chosen)
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
            quad.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        """Release all OpenGL resources."""
        for program, quad in self._programs.values():
            quad.release()
            program.release()
        self._programs = {}

    def _compile(self, chosen: tuple[bool, ...]) -> tuple[moderngl.Program, moderngl.VertexArray]:
        constants = dict(zip(self._constants, chosen, strict=True))
        stages = Source("display.vert", None, _VERSION), Source(self._shader, constants, _VERSION)
        program = drawing(self._gl, *stages)
        self._programs[chosen] = program, self._gl.vertex_array(program, [])
        return self._programs[chosen]
