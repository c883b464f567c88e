"""A texture that is drawn on follows the size that is wanted; a part of it is magnified exactly."""

import moderngl
import numpy as np
import pytest

from glrt.gpu.canvas import Canvas
from glrt.gpu.context import Context
from glrt.rendering.screen.magnifier import Magnifier


@pytest.mark.parametrize("dtype", ["f1", "f4"])
def test_a_canvas_has_the_size_that_is_wanted_and_keeps_it(context: Context, dtype: str) -> None:
    with context.gl:
        canvas = Canvas(context.gl, dtype)
        for size in ((4, 3), (4, 3), (5, 2)):
            before = canvas.texture
            target = canvas.sized(size)
            assert canvas.texture
            assert (target.size, canvas.texture.size, canvas.texture.dtype) == (size, size, dtype)
            assert (canvas.texture is before) == (before is not None and before.size == size)
        canvas.release()
        assert canvas.texture is None


@pytest.mark.parametrize("part", [(0, 0, 6, 4), (1, 2, 3, 2), (4, 1, 2, 3)])
def test_a_part_is_magnified_pixel_by_pixel(
    context: Context, part: tuple[int, int, int, int]
) -> None:
    """Row 0 of a picture is the lowest of its texture; the part counts from the upper left."""
    left, top, width, height = part
    codes = np.random.default_rng(1).integers(0, 256, (4, 6, 4), np.uint8)
    with context.gl:
        picture = context.gl.texture((6, 4), 4, codes[::-1].tobytes())
        picture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        magnifier = Magnifier(context.gl)
        shown = magnifier.draw(picture, part, (7 * width, 7 * height))
        found = np.frombuffer(shown.read(), np.uint8).reshape(7 * height, 7 * width, 4)[::-1]
        magnifier.release()
        picture.release()
    wanted = codes[top : top + height, left : left + width]
    assert np.array_equal(found, wanted.repeat(7, axis=0).repeat(7, axis=1))
