"""Textures that are drawn on, made anew where another size is wanted."""

import moderngl


class Canvas:
    """RGBA, 8 bits a channel or float32 (`dtype` "f4"); nothing is allocated before it is used.

    `count` textures are drawn on at once, 8 at most: OpenGL promises no more.
    """

    def __init__(self, gl: moderngl.Context, dtype: str = "f1", count: int = 1) -> None:
        """Without a size."""
        self._gl, self._dtype, self._count = gl, dtype, count
        self.textures: list[moderngl.Texture] = []
        self._target: moderngl.Framebuffer | None = None

    @property
    def texture(self) -> moderngl.Texture | None:
        """The first of them; None without a size."""
        return self.textures[0] if self.textures else None

    def sized(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        """What draws on it, at a size in pixels; of another size than before, it is empty."""
        if self._target is None or self._target.size != size:
            self.release()
            for _ in range(self._count):
                self.textures.append(self._gl.texture(size, 4, dtype=self._dtype))
            self._target = self._gl.framebuffer(self.textures)
        return self._target

    def release(self) -> None:
        """Free what the driver holds."""
        if self._target:
            self._target.release()
        for texture in self.textures:
            texture.release()
        self.textures, self._target = [], None
