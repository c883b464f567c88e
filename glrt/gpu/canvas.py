"""Textures that are drawn on, replaced where another size is needed."""

import moderngl


class Canvas:
    """RGBA textures, 8 bits a channel or float32 (`dtype` "f4"), that are allocated on first use.

    `count` textures are drawn on at once, 8 at most: OpenGL promises no more.
    """

    def __init__(self, gl: moderngl.Context, dtype: str = "f1", count: int = 1) -> None:
        """Create a canvas without a size and without textures."""
        self._gl, self._dtype, self._count = gl, dtype, count
        self.textures: list[moderngl.Texture] = []
        self._target: moderngl.Framebuffer | None = None

    @property
    def texture(self) -> moderngl.Texture | None:
        """The first texture; None before there is a size."""
        return self.textures[0] if self.textures else None

    def sized(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        """Return the framebuffer at a size in pixels; a change of size brings new textures."""
        if self._target is None or self._target.size != size:
            self.release()
            for _ in range(self._count):
                self.textures.append(self._gl.texture(size, 4, dtype=self._dtype))
            self._target = self._gl.framebuffer(self.textures)
        return self._target

    def release(self) -> None:
        """Free the textures and the framebuffer."""
        if self._target:
            self._target.release()
        for texture in self.textures:
            texture.release()
        self.textures, self._target = [], None
