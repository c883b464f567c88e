"""Sheets of pictures for docs: renders with a title above, in rows."""

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.contact_sheet import FORMATS, MOST_BYTES, Codes, write_bytes
from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.image.tonemap import expose_and_encode
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene

TITLE = 16  # pixels above a picture
PAPER, INK = 255, (30, 30, 34)
TRIES: dict[str, list[dict[str, Any]]] = {  # options of a file: the first that is small enough
    "JPEG": [{"quality": quality, "subsampling": 0} for quality in (88, 80, 72, 64)],
    "PNG": [{"optimize": True}],
}


def rendered(context: Context, scene: Scene, variant: Variant = PLAIN, **settings: Any) -> Codes:
    """Return a render as its PNG file shows it: denoised, exposed, by its tone curve."""
    ways: dict[str, Any] = {"tier": "complete", "opens_shutter": True, "variant": variant}
    ways |= settings
    renderer = Renderer(scene, None, context, **ways)
    try:
        image = renderer.render().image()
    finally:
        renderer.release()
    return expose_and_encode(image.shown, renderer.settings.exposure, renderer.settings.tonemap)


def titled(title: str, radiance: NDArray[Any]) -> Codes:
    """Return a picture of radiance as codes, (H + TITLE, W, 3), with its title above."""
    from PIL import Image, ImageDraw

    codes = expose_and_encode(radiance, 0.0, "neutral")
    height, width, _ = codes.shape
    paper = Image.fromarray(np.full((height + TITLE, width, 3), PAPER, np.uint8))
    paper.paste(Image.fromarray(codes), (0, TITLE))
    ImageDraw.Draw(paper).text((2, 2), title, fill=INK)
    return np.asarray(paper)


def in_rows(pictures: Sequence[Codes], columns: int, gap: int = 0) -> Codes:
    """Return pictures of one size in rows, with paper between them and after the last."""
    height, width, _ = pictures[0].shape
    rows = -(-len(pictures) // columns)
    size = rows * (height + gap) - gap, columns * (width + gap) - gap, 3
    sheet = np.full(size, PAPER, np.uint8)
    for number, picture in enumerate(pictures):
        top, left = number // columns * (height + gap), number % columns * (width + gap)
        sheet[top : top + height, left : left + width] = picture
    return sheet


def write_sheet(file: Path, sheet: Codes) -> None:
    """Write a sheet as JPEG or PNG, by suffix; RenderError if it is too large for docs."""
    from PIL import Image

    kind = FORMATS[file.suffix.lower()]
    for options in TRIES[kind]:
        encoded = io.BytesIO()
        Image.fromarray(sheet).save(encoded, kind, **options)
        data = encoded.getvalue()
        if len(data) < MOST_BYTES:
            write_bytes(file, data)
            return
    raise RenderError(f"{file} has more than {MOST_BYTES} bytes. Make its pictures smaller.")
