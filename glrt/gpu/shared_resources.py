"""Buffers and textures that several users hold, freed by the last."""

from typing import Self

import moderngl


class Shared:
    """A buffer or a texture, and how many use it."""

    def __init__(self, resource: moderngl.Buffer | moderngl.Texture) -> None:
        """For one user."""
        self.resource, self._users = resource, 1
        self.content: object = None  # what it holds, where users write it in turn

    def shared(self) -> Self:
        """This, for one more user."""
        self._users += 1
        return self

    def release(self) -> None:
        """One user less."""
        self._users -= 1
        if self._users == 0:
            self.resource.release()
