"""Small pictures of the scenes that come with glrt, in one file that `bench.thumbnails` renders."""

import json
from contextlib import suppress
from typing import NamedTuple

import moderngl

from glrt.core.resources import folder

FILE = "thumbnails.jpg"  # in the folder of the scenes; its comment maps names to titles, as JSON
TILE = 224, 168  # pixels of one picture
COLUMNS = 6


class Part(NamedTuple):
    """Where the picture of a scene is in the texture, from (0, 0) to (1, 1), and its title."""

    low: tuple[float, float]
    high: tuple[float, float]
    title: str


class Thumbnails:
    """The pictures as one texture; a scene without one is left out."""

    def __init__(self, gl: moderngl.Context) -> None:
        """Read the file; without it, as in a damaged installation, there are no pictures."""
        self.texture: moderngl.Texture | None = None
        self.parts: dict[str, Part] = {}
        with suppress(OSError, ValueError):
            self._read(gl)

    def _read(self, gl: moderngl.Context) -> None:
        from PIL import Image

        with Image.open(folder("scenes") / FILE) as picture:
            titles, size = json.loads(picture.info["comment"]), picture.size
            self.texture = gl.texture(size, 3, picture.convert("RGB").tobytes(), alignment=1)
        self.texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        width, height = TILE[0] / size[0], TILE[1] / size[1]
        for number, (name, title) in enumerate(titles.items()):
            row, column = divmod(number, COLUMNS)
            left, top = column * width, row * height
            self.parts[name] = Part((left, top), (left + width, top + height), title)

    def release(self) -> None:
        """Release the texture."""
        if self.texture:
            self.texture.release()
        self.texture = None
