"""A texture that is drawn on, made anew where another size is wanted."""

import moderngl


class Canvas:
    """RGBA, 8 bits a channel or float32 (`dtype` "f4"); nothing is allocated before it is used."""

    def __init__(self, gl: moderngl.Context, dtype: str = "f1") -> None:
        """Without a size."""
        self._gl, self._dtype = gl, dtype
        self.texture: moderngl.Texture | None = None
        self._target: moderngl.Framebuffer | None = None

    def sized(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        """What draws on it, at a size in pixels; of another size than before, it is empty."""
        if self._target is None or self._target.size != size:
            self.release()
            self.texture = self._gl.texture(size, 4, dtype=self._dtype)
            self._target = self._gl.framebuffer([self.texture])
        return self._target

    def release(self) -> None:
        """Free what the driver holds."""
        if self.texture and self._target:
            self._target.release()
            self.texture.release()
        self.texture = self._target = None
