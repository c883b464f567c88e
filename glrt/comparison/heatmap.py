"""Where two pictures differ: the scores of pixels and of blocks as a PNG with a colour bar."""

import textwrap
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.comparison.regions import Array, spread_out
from glrt.comparison.result import Comparison
from glrt.core import files

Colors = NDArray[np.uint8]

SPAN = 6  # the score at either end of the colour bar
SMALLEST_PANEL = 320  # pixels on the longer side: smaller pictures are enlarged
MARGIN, TITLE, BAR, TICKS = 16, 22, 18, 44  # pixels

_BELOW = np.array([[8, 48, 107], [66, 146, 198], [247, 247, 247]], np.float64)
_ABOVE = np.array([[247, 247, 247], [239, 101, 72], [127, 0, 0]], np.float64)


def save_picture(comparison: Comparison, path: str | Path) -> None:
    """Write a PNG: on the left the score of each pixel, on the right that of its block.

    Red where the image is brighter than the reference, blue where it is darker, of the channel
    that differs most. The worst block has a frame. Raises `RenderError` if it cannot be written.
    """
    canvas = _draw(comparison)
    files.write_whole(Path(path), lambda file: canvas.save(file, format="PNG"))


def colors(scores: Array) -> Colors:
    """Colours of scores of any shape, (..., 3) uint8: blue below 0, white, red above."""
    place = np.clip(scores / SPAN, -1, 1)[..., None]
    dark, middle, light = _BELOW
    below = np.where(
        place < -0.5, _mix(middle, dark, -2 * place - 1), _mix(light, middle, -2 * place)
    )
    light, middle, dark = _ABOVE
    above = np.where(place > 0.5, _mix(middle, dark, 2 * place - 1), _mix(light, middle, 2 * place))
    return np.asarray(np.rint(np.where(place < 0, below, above)), np.uint8)


def _mix(near: Array, far: Array, share: Array) -> Array:
    return near + (far - near) * share


def strongest(scores: Array) -> Array:
    """The score of the channel that lies farthest from 0, without the last axis."""
    channel = np.abs(scores).argmax(axis=-1)[..., None]
    return np.asarray(np.take_along_axis(scores, channel, axis=-1)[..., 0])


def _draw(comparison: Comparison) -> Any:
    from PIL import Image, ImageDraw

    shape = comparison.pixel_scores.shape
    zoom = max(1, -(-SMALLEST_PANEL // max(shape[:2])))
    height, width = shape[0] * zoom, shape[1] * zoom
    lines = textwrap.wrap(str(comparison), max((2 * width + MARGIN) // 7, 20))
    top = MARGIN + TITLE * (len(lines) + 1)
    right = 3 * MARGIN + 2 * width
    canvas = Image.new("RGB", (right + BAR + TICKS + MARGIN, top + height + MARGIN), "white")
    draw = ImageDraw.Draw(canvas)
    for row, line in enumerate(lines):
        _text(draw, (MARGIN, MARGIN + TITLE * row), line)
    blocks = spread_out(comparison.block_scores, shape)
    panels = [("pixels: they locate", comparison.pixel_scores), ("blocks: they decide", blocks)]
    for column, (caption, scores) in enumerate(panels):
        left = MARGIN + column * (width + MARGIN)
        _text(draw, (left, top - TITLE), caption)
        panel = Image.fromarray(colors(strongest(scores)))
        canvas.paste(panel.resize((width, height), Image.Resampling.NEAREST), (left, top))
        _frame(draw, comparison, left, top, zoom)
    _color_bar(canvas, draw, right, top, height)
    return canvas


def _frame(draw: Any, comparison: Comparison, left: int, top: int, zoom: int) -> None:
    """Draw a frame around the worst block, on the outside: it covers no pixel of it."""
    block = comparison.worst
    x, y = left + zoom * block.x, top + zoom * block.y
    end = (x + zoom * block.width + 1, y + zoom * block.height + 1)
    draw.rectangle(((x - 2, y - 2), end), outline="black", width=2)


def _color_bar(canvas: Any, draw: Any, left: int, top: int, height: int) -> None:
    from PIL import Image

    scores = np.repeat(np.linspace(SPAN, -SPAN, height)[:, None], BAR, axis=1)
    canvas.paste(Image.fromarray(colors(scores)), (left, top))
    _text(draw, (left, top - TITLE), "score")
    ticks = range(-SPAN, SPAN + 1, 2 if height >= 7 * TITLE else 2 * SPAN)
    for score in ticks:
        y = top + (SPAN - score) * (height - 1) // (2 * SPAN)
        draw.line(((left + BAR, y), (left + BAR + 4, y)), fill="black")
        place = min(max(y - 8, top), top + height - 16)
        _text(draw, (left + BAR + 8, place), f"{score:+d}" if score else "0")


def _text(draw: Any, corner: tuple[int, int], text: str) -> None:
    from PIL import ImageFont

    draw.text(corner, text, fill="black", font=ImageFont.load_default(14))
