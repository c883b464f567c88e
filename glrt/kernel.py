"""One compiled program, its blocks and images bound by name; the only dispatcher."""

from collections.abc import Mapping

import moderngl

from glrt.errors import RenderError
from glrt.shader import Source

GROUP = 8  # work group of 8 x 8, as in trace.comp


def tile_count(width: int, height: int) -> int:
    """How many work groups cover a picture."""
    return -(-width // GROUP) * -(-height // GROUP)


class Kernel:
    """A compute shader."""

    def __init__(self, gl: moderngl.Context, source: Source) -> None:
        """Compile; RenderError tells the driver's message by shader file and line."""
        try:
            self._program = gl.compute_shader(source.text)
        except moderngl.Error as error:
            message = " ".join(source.explain(str(error)).split())
            raise RenderError(f"the driver refuses the kernel: {message}") from error

    @property
    def names(self) -> set[str]:
        """The blocks, images and uniforms that the compiled program uses."""
        return set(self._program)

    def bind(
        self,
        buffers: Mapping[str, moderngl.Buffer],
        images: Mapping[str, moderngl.Texture],
    ) -> None:
        """Give each block and image of the program the buffer or texture of its name.

        Blocks that the compiler dropped need none; a missing one is a KeyError with its name.
        """
        for slot, name in enumerate(self._program):
            member = self._program[name]
            if isinstance(member, moderngl.UniformBlock):
                member.binding = slot
                buffers[name].bind_to_uniform_block(slot)
            elif isinstance(member, moderngl.StorageBlock):
                member.binding = slot
                buffers[name].bind_to_storage_buffer(slot)
        for unit, name in enumerate(images):
            if name in self._program:
                self._program[name] = unit
                images[name].bind_to_image(unit)

    def run(self, width: int, height: int) -> None:
        """Dispatch over a grid of pixels."""
        self.run_tiles(tile_count(width, height))

    def run_tiles(self, count: int) -> None:
        """Dispatch work groups, whatever pixels they stand for."""
        self._program.run(count, 1, 1)

    def release(self) -> None:
        """Free the program."""
        self._program.release()
