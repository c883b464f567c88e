"""Compiled programs with blocks and images bound by name; they alone dispatch work."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import count

import moderngl

from glrt.core.errors import RenderError
from glrt.core.text import one_line
from glrt.gpu.glsl import Source, read
from glrt.gpu.structs import read_constants
from glrt.process.signals import postponed

TILE = read_constants(read("passes/tiles.glsl"))["TILE"]  # pixels along the edge of a tile

SAMPLED = ("source_layers",)  # textures of a film that are no images of a compute shader
Resource = moderngl.Buffer | moderngl.Texture
Images = Mapping[str, moderngl.Texture]


def tile_count(width: int, height: int) -> int:
    """Return how many tiles cover a picture."""
    return -(-width // TILE) * -(-height // TILE)


@dataclass
class Pace:
    """The speed of a program's dispatches so far; work is samples x tiles."""

    tried: float = 0.0  # the most work of one dispatch
    cost: float = 0.0  # seconds for one tile and sample
    cost_alone: float = 0.0  # the same for one sample alone, whose lanes wait for the longest path
    rounds: int = 0  # loop rounds of a sample; with more, the rest is no longer valid

    def learn(self, other: "Pace") -> None:
        """Take over the speed of a program that does the same, unless this one has dispatched."""
        if not self.tried:
            self.tried, self.cost, self.cost_alone = other.tried, other.cost, other.cost_alone
            self.rounds = other.rounds


class Kernel:
    """A compute shader: a tile is a work group, and images are read and written in place.

    OpenGL 4.3 grants only 8 images. Names in SAMPLED are textures in the shader.
    """

    def __init__(self, gl: moderngl.Context, source: Source) -> None:
        """Compile; RenderError gives the driver's message by shader file and line."""
        self._gl, self.pace = gl, Pace()
        try:
            with postponed():  # moderngl names a program's parts in Python: Ctrl-C there crashes it
                self._program = gl.compute_shader(source.live.text)
        except moderngl.Error as error:
            raise _refusal(source, error) from error

    @property
    def names(self) -> set[str]:
        """The blocks, images and uniforms that the compiled program uses."""
        return set(self._program)

    def bind(self, scene: Mapping[str, Resource], images: Images) -> None:
        """Give each block and image of the program the buffer or texture of its name.

        Names that the compiler dropped need none; a missing one is a KeyError with its name.
        """
        bind_blocks(self._program, scene)
        sampled = {name: images[name] for name in images if name in SAMPLED}
        bind_textures(self._program, {**scene, **sampled})
        used = [name for name in images if name not in sampled and name in self._program]
        for unit, name in enumerate(used):
            self._program[name] = unit
            images[name].bind_to_image(unit)

    def run(self, width: int, height: int) -> None:
        """Dispatch over a picture of this size in pixels."""
        self.run_tiles(tile_count(width, height))

    def run_tiles(self, tiles: int) -> None:
        """Dispatch so many work groups; later commands see what they wrote."""
        self._program.run(tiles, 1, 1)
        self._gl.memory_barrier()

    def rest(self) -> None:
        """Release what was bound: a compute shader holds nothing."""

    def release(self) -> None:
        """Free the program."""
        self._program.release()


class FragmentKernel:
    """A vertex and a fragment shader: a tile is an instance of a quad, drawn over the targets."""

    def __init__(self, gl: moderngl.Context, vertex: Source, fragment: Source) -> None:
        """Compile; RenderError gives the driver's message by shader file and line."""
        self._gl, self.pace = gl, Pace()
        self._targets: moderngl.Framebuffer | None = None
        self._program = drawing(gl, vertex, fragment)
        self._quad = gl.vertex_array(self._program, [])

    def bind(self, scene: Mapping[str, Resource], images: Images) -> None:
        """Bind as Kernel.bind; images named "target..." are drawn to, in their order."""
        bind_blocks(self._program, scene)
        bind_textures(self._program, {**scene, **images})
        self.rest()
        targets = [texture for name, texture in images.items() if name.startswith("target")]
        self._targets = self._gl.framebuffer(color_attachments=targets)

    def run_tiles(self, tiles: int) -> None:
        """Draw tiles, untouched by what a window has turned on, such as blending."""
        with self._gl.scope(self._targets, moderngl.NOTHING):
            self._quad.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=tiles)

    def release(self) -> None:
        """Free the program."""
        self.rest()
        self._quad.release()
        self._program.release()

    def rest(self) -> None:
        """Release the framebuffer of what was bound."""
        if self._targets:
            self._targets.release()
            self._targets = None


def drawing(gl: moderngl.Context, vertex: Source, fragment: Source) -> moderngl.Program:
    """Return a program that draws; RenderError gives the driver's message by file and line."""
    try:
        with postponed():  # as in Kernel
            return gl.program(vertex_shader=vertex.live.text, fragment_shader=fragment.live.text)
    except moderngl.Error as error:
        raise _refusal(fragment, error) from error


def bind_blocks(
    program: moderngl.ComputeShader | moderngl.Program, scene: Mapping[str, Resource]
) -> None:
    """Bind the blocks; each kind counts from 0, as OpenGL 4.3 grants only 8 storage blocks."""
    slots = {moderngl.UniformBlock: count(), moderngl.StorageBlock: count()}
    for name in program:
        member = program[name]
        if not isinstance(member, moderngl.UniformBlock | moderngl.StorageBlock):
            continue
        member.binding = slot = next(slots[type(member)])
        buffer = scene[name]
        assert isinstance(buffer, moderngl.Buffer)
        if isinstance(member, moderngl.UniformBlock):
            buffer.bind_to_uniform_block(slot)
        else:
            buffer.bind_to_storage_buffer(slot)


def bind_textures(
    program: moderngl.ComputeShader | moderngl.Program, resources: Mapping[str, Resource]
) -> None:
    """Bind the textures of a program, by the names of its samplers."""
    units = count()  # OpenGL 4.3 grants 16 textures to a shader
    for name, texture in resources.items():
        if isinstance(texture, moderngl.Texture) and name in program:
            program[name] = unit = next(units)
            texture.use(unit)


def _refusal(source: Source, error: moderngl.Error) -> RenderError:
    message = one_line(source.live.explain(str(error)))
    return RenderError(f"the driver refuses a shader: {message}")
