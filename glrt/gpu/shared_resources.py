"""Buffers and textures that several users hold, freed by the last."""

from typing import Self

import moderngl


class Shared:
    """A buffer or a texture, and the number of its users."""

    def __init__(self, resource: moderngl.Buffer | moderngl.Texture) -> None:
        """Hold a resource for one user."""
        self.resource, self._users = resource, 1
        self.content: object = None  # its present content, where users write it in turn

    def shared(self) -> Self:
        """Count one user more and return this object."""
        self._users += 1
        return self

    def release(self) -> None:
        """Count one user less; the last one frees the resource."""
        self._users -= 1
        if self._users == 0:
            self.resource.release()
