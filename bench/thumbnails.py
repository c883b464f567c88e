"""The thumbnails of the start screen: every scene that comes with glrt, in one small picture.

`python -m bench.thumbnails` renders them again, after a scene was added or changed.
"""

import argparse
import io
import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core import files
from glrt.core.resources import folder
from glrt.gpu.context import open_context
from glrt.image.image import Image as Picture
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import scene_names
from glrt.view.start.thumbnails import COLUMNS, FILE, TILE

Codes = NDArray[np.uint8]  # (H, W, 3) sRGB

SAMPLES = 1024
BACK = 32  # sRGB code of a tile beyond its picture
MOST_BYTES = 250_000
QUALITIES = (90, 85, 80, 75, 70, 65, 60)


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.thumbnails`; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m bench.thumbnails", description=__doc__)
    parser.add_argument("-o", dest="file", type=Path, default=folder("scenes") / FILE)
    parser.add_argument("--samples", type=int, default=SAMPLES, help="samples of each pixel")
    parsed = parser.parse_args(arguments)
    scenes = {name: load(name) for name in scene_names()}
    tiles = list(rendered(scenes, parsed.samples))
    data = sheet(tiles, {name: scene.title or name for name, scene in scenes.items()})
    files.write_whole(parsed.file, partial(_write, data))
    return 0


def _write(data: bytes, file: Path) -> None:
    file.write_bytes(data)


def rendered(scenes: Mapping[str, Scene], samples: int) -> Iterator[Codes]:
    """Render a tile of each scene, without its noise, whole and as large as TILE allows."""
    context = open_context()
    for name, scene in scenes.items():
        print(name, file=sys.stderr, flush=True)
        sizes: dict[str, Any] = dict(zip(("width", "height"), fitting(scene), strict=True))
        renderer = Renderer(scene, None, context, samples=samples, denoise="auto", **sizes)
        try:
            yield framed(codes_of(renderer.render().image()))
        finally:
            renderer.release()


def fitting(scene: Scene) -> tuple[int, int]:
    """Return the largest size in pixels with the aspect of a scene that fits into TILE."""
    width, height = scene.render.width, scene.render.height
    scale = min(TILE[0] / width, TILE[1] / height)
    return round(scale * width), round(scale * height)


def codes_of(image: Picture) -> Codes:
    """Return the pixels of an image as its PNG file has them."""
    from PIL import Image

    with TemporaryDirectory() as place:
        file = Path(place) / "tile.png"
        image.save(file)
        with Image.open(file) as picture:
            return np.asarray(picture.convert("RGB"))


def framed(picture: Codes) -> Codes:
    """Return a picture in the middle of a tile, (height, width, 3) of TILE."""
    height, width = picture.shape[:2]
    left, top = (TILE[0] - width) // 2, (TILE[1] - height) // 2
    tile = np.full((TILE[1], TILE[0], 3), BACK, np.uint8)
    tile[top : top + height, left : left + width] = picture
    return tile


def sheet(tiles: Sequence[Codes], titles: Mapping[str, str]) -> bytes:
    """Return a JPEG with the tiles in rows of COLUMNS; its comment maps their names to titles."""
    from PIL import Image

    rows = -(-len(tiles) // COLUMNS)
    whole = np.zeros((rows * TILE[1], COLUMNS * TILE[0], 3), np.uint8)
    for number, tile in enumerate(tiles):
        top, left = number // COLUMNS * TILE[1], number % COLUMNS * TILE[0]
        whole[top : top + TILE[1], left : left + TILE[0]] = tile
    comment = json.dumps(titles).encode()
    for quality in QUALITIES:
        file = io.BytesIO()
        Image.fromarray(whole).save(file, "JPEG", quality=quality, comment=comment)
        if file.tell() < MOST_BYTES:
            break
    return file.getvalue()


if __name__ == "__main__":
    sys.exit(main())
