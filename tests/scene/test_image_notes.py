"""Notes in images, inks, and texels: what pixels do and do not depend on."""

import struct
import zlib
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image as Pillow

from glrt.core.errors import SceneError
from glrt.scene.images.image_files import decode_image, decode_texels
from tests.scene.test_image_files import CHANNELS, DRAW, codes_of
from tests.support.image_bytes import (
    COLOR,
    COLOR_ALPHA,
    GREY,
    GREY_ALPHA,
    WHERE,
    chunk,
    png,
    saved,
)


def is_read_as(truth: Any, content: bytes) -> bool:
    """Whether an image is read, and has these values."""
    try:
        return bool((decode_image(content, WHERE) == truth).all())
    except SceneError:
        return False


def test_inks_of_a_jpeg_filter_white() -> None:
    inks = Pillow.new("CMYK", (8, 8), (255, 51, 0, 102))
    found = decode_image(saved(inks, "JPEG", quality=100), WHERE, color=False)
    assert_allclose(found, np.broadcast_to([0, 0.8 * 0.6, 0.6], (8, 8, 3)), atol=2 / 255)


def test_notes_of_a_jpeg_keep_no_pixel_from_being_read() -> None:
    content = saved(Pillow.fromarray(codes_of(COLOR, np.uint8)), "JPEG")
    truth = decode_image(content, WHERE)
    for kind in (*range(0xE0, 0xF0), 0xFE):
        for note in (b"", b"Exif\0\0II*\0\xff", b"ICC_PROFILE\0\2", b"JFIF\0", b"Adobe\0d"):
            part = bytes([0xFF, kind]) + struct.pack(">H", 2 + len(note)) + note
            assert is_read_as(truth, content[:2] + part + content[2:]), (kind, note)


def test_notes_of_a_png_keep_no_pixel_from_being_read() -> None:
    codes = codes_of(COLOR, np.uint8)
    truth = decode_image(png(codes, COLOR), WHERE)
    for kind in (b"iCCP", b"gAMA", b"cHRM", b"sRGB", b"pHYs", b"tEXt", b"zTXt", b"eXIf", b"fcTL"):
        for note in (b"", b"x\0\0noise", b"x\0\0" + zlib.compress(bytes(1 << 24))):
            part = chunk(kind, note)
            for extra in (part, part[:-1] + bytes([part[-1] ^ 1])):  # and with a wrong sum
                assert is_read_as(truth, png(codes, COLOR, extra)), kind


@pytest.mark.parametrize("color", [True, False])
@pytest.mark.parametrize("kind", CHANNELS)
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_texels_are_the_values_of_the_image(kind: int, color: bool, dtype: type) -> None:
    """All codes are there, in more rows than are looked up at once."""
    codes = np.arange(4 * 300 * 350) % (np.iinfo(dtype).max + 1)
    codes = DRAW.permutation(codes).astype(dtype).reshape(300, 350, 4)[..., : CHANNELS[kind]]
    content = png(np.ascontiguousarray(codes), kind)
    texels, values = decode_texels(content, WHERE, color), decode_image(content, WHERE, color)
    is_grey = kind in (GREY, GREY_ALPHA)
    assert texels.dtype == np.float16
    expected = values[..., :1] if is_grey else values[..., :3]
    assert (texels[..., :3] == expected.astype(np.float16)).all()
    has_alpha = kind in (GREY_ALPHA, COLOR_ALPHA)
    assert (texels[..., 3] == (values[..., -1].astype(np.float16) if has_alpha else 1)).all()
