"""A program that draws vertices which it numbers itself, part by part, into a depth buffer."""

from collections.abc import Mapping
from typing import NamedTuple

import moderngl

from glrt.gpu.glsl import Source
from glrt.gpu.program import Images, Pace, Resource, bind_blocks, bind_textures, drawing

PART, SIZE = "raster_part", "raster_size"  # uniforms
VERTICES = 6  # of two triangles, for each thing that is drawn


class Draw(NamedTuple):
    """One draw call: what it draws, by its number in shaders_glsl/raster.glsl, and how many."""

    part: int
    times: int


class RasterKernel:
    """A vertex and a fragment shader that draw over a target: the first part over everything."""

    def __init__(self, gl: moderngl.Context, vertex: Source, fragment: Source) -> None:
        """Compile; RenderError gives the driver's message by shader file and line."""
        self._gl, self.pace = gl, Pace()
        self._program = drawing(gl, vertex, fragment)
        self._vertices = gl.vertex_array(self._program, [])
        self.target: moderngl.Framebuffer | None = None
        self.draws: tuple[Draw, ...] = ()

    def bind(self, scene: Mapping[str, Resource], images: Images) -> None:
        """Bind the blocks and textures of a scene; `images` of a film are not drawn on."""
        bind_blocks(self._program, scene)
        bind_textures(self._program, scene)

    def run_tiles(self, tiles: int) -> None:
        """Draw all parts, whatever `tiles`, untouched by what a window has turned on."""
        assert self.target
        self._program[SIZE] = self.target.size
        with self._gl.scope(self.target, moderngl.DEPTH_TEST):
            for number, (part, times) in enumerate(self.draws):
                self._gl.depth_func = "<" if number else "1"
                self._program[PART] = part
                if times:
                    self._vertices.render(moderngl.TRIANGLES, vertices=VERTICES * times)
            self._gl.depth_func = "<"

    def rest(self) -> None:
        """Forget the target."""
        self.target, self.draws = None, ()

    def release(self) -> None:
        """Free the program."""
        self._vertices.release()
        self._program.release()
