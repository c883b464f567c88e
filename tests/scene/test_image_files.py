"""PNG, JPEG and WebP as linear values; images of all formats with faults.

PNG files are written here byte by byte, so that each kind of pixel is known beforehand.
"""

import io
import struct
from collections.abc import Callable
from typing import Any

import numpy as np
import PIL
import pytest
from numpy.typing import NDArray
from PIL import Image as Pillow
from PIL import features

from glrt.core.errors import SceneError
from glrt.scene.images import image_files
from glrt.scene.images.codes import decode_srgb
from glrt.scene.images.image_files import decode_image
from tests.fuzz.hunt import hunt
from tests.fuzz.pictures import broken
from tests.support.image_bytes import (
    COLOR,
    COLOR_ALPHA,
    GREY,
    GREY_ALPHA,
    PALETTE,
    WHERE,
    chunk,
    exr,
    flat_hdr,
    png,
    raw_png,
    refusal,
    rle_hdr,
    saved,
)

CHANNELS = {GREY: 1, COLOR: 3, GREY_ALPHA: 2, COLOR_ALPHA: 4}
PILLOW = tuple(map(int, PIL.__version__.split(".")[:2]))
DRAW = np.random.default_rng(3)

Codes = NDArray[Any]


def codes_of(kind: int, dtype: type) -> Codes:
    """All extremes are among them."""
    shape = (5, 7, CHANNELS[kind])
    codes: Codes = DRAW.integers(0, np.iinfo(dtype).max + 1, shape).astype(dtype)
    codes.flat[:2] = 0, np.iinfo(dtype).max
    return codes


def as_srgb(code: float) -> float:
    """IEC 61966-2-1, on plain numbers."""
    return code / 12.92 if code <= 0.04045 else ((code + 0.055) / 1.055) ** 2.4


# --- PNG -------------------------------------------------------------------------------------


@pytest.mark.parametrize("adam7", [False, True])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("kind", CHANNELS)
def test_every_code_of_a_png_is_kept(kind: int, dtype: type, adam7: bool) -> None:
    codes = codes_of(kind, dtype)
    pixels = decode_image(png(codes, kind, adam7=adam7), WHERE, color=False)
    assert pixels.dtype == np.float32
    assert pixels.shape == (5, 7, CHANNELS[kind])
    assert (pixels == (codes / np.iinfo(dtype).max).astype(np.float32)).all()


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_colours_are_decoded_from_srgb_and_alpha_is_not(dtype: type) -> None:
    most = np.iinfo(dtype).max
    shown = [0, 1, most // 25, most // 24, most // 4, most // 2, most - 1, most]
    codes: Codes = np.array([[[code, most, 0, code] for code in shown]], dtype)
    pixels = decode_image(png(codes, COLOR_ALPHA), WHERE)
    truth = np.array([[as_srgb(code / most), 1, 0, code / most] for code in shown])
    assert np.allclose(pixels[0], truth, rtol=1e-6, atol=0)
    grey = decode_image(png(codes[:, :, [0, 3]], GREY_ALPHA), WHERE)
    assert (grey == pixels[:, :, [0, 3]]).all()


def test_the_srgb_curve_has_known_values() -> None:
    linear = decode_srgb(np.array([0, 0.04045, 0.5, 188 / 255, 1]))
    assert np.allclose(linear, [0, 0.0031308, 0.21404114, 0.50288646, 1], rtol=1e-5)


def test_a_palette_becomes_its_colours_with_their_alpha() -> None:
    entries = chunk(b"PLTE", bytes([255, 0, 0, 0, 255, 0, 0, 0, 51]))
    rows = b"\0\0\1\2\0\2\2\0"
    opaque: Codes = decode_image(raw_png(3, 2, 8, PALETTE, rows, entries), WHERE, color=False)
    red, green, blue = np.diag([1, 1, 0.2])
    assert np.allclose(opaque, np.array([[red, green, blue], [blue, blue, red]]))
    for alpha, first in ((b"\0", 0), (b"\x33\xff", 0.2)):
        extra = entries + chunk(b"tRNS", alpha)
        pixels = decode_image(raw_png(3, 2, 8, PALETTE, rows, extra), WHERE, color=False)
        assert np.allclose(pixels[:, :, 3], np.array([[first, 1, 1], [1, 1, first]]))
        assert (pixels[:, :, :3] == opaque).all()


@pytest.mark.parametrize("depth", [1, 2, 4])
def test_grey_of_few_bits_reaches_from_0_to_1(depth: int) -> None:
    most = (1 << depth) - 1
    code = most - 1 if depth > 1 else 0
    row = bytes([most << (8 - depth) | code << (8 - 2 * depth)])
    extra = chunk(b"tRNS", struct.pack(">H", code))
    pixels = decode_image(raw_png(2, 1, depth, GREY, b"\0" + row), WHERE, color=False)
    assert np.allclose(pixels.ravel(), [1, code / most])
    keyed = decode_image(raw_png(2, 1, depth, GREY, b"\0" + row, extra), WHERE, color=False)
    assert np.allclose(keyed.ravel(), [1, 1, code / most, 0])


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("kind", [GREY, COLOR])
def test_a_transparent_colour_becomes_alpha(kind: int, dtype: type) -> None:
    codes = codes_of(kind, dtype)
    codes[0, 0] = codes[1, 1] = codes[3, 4]
    codes[1, 1, 0] ^= 1  # another colour, though two of three channels are the same
    key = struct.pack(f">{CHANNELS[kind]}H", *map(int, codes[3, 4]))
    pixels = decode_image(png(codes, kind, chunk(b"tRNS", key)), WHERE, color=False)
    plain = decode_image(png(codes, kind), WHERE, color=False)
    assert (pixels[:, :, :-1] == plain).all()
    assert ((pixels[:, :, -1] == 0) == (codes == codes[3, 4]).all(axis=2)).all()
    assert set(np.unique(pixels[:, :, -1])) == {0, 1}


def test_a_gamma_a_profile_and_damaged_metadata_are_ignored() -> None:
    codes = codes_of(COLOR, np.uint8)
    extra = chunk(b"gAMA", struct.pack(">I", 100000)) + chunk(b"iCCP", b"x\0\0not a profile")
    extra += chunk(b"acTL", bytes(8))  # an animation of no pictures: Pillow warns
    pixels = decode_image(png(codes, COLOR, extra), WHERE)
    assert (pixels == decode_image(png(codes, COLOR), WHERE)).all()


# --- JPEG and WebP ---------------------------------------------------------------------------


def test_a_jpeg_is_what_pillow_reads_of_it() -> None:
    smooth = np.add.outer(np.arange(32), np.arange(48)).astype(np.uint8)
    for image in (Pillow.fromarray(smooth), Pillow.fromarray(np.stack([smooth] * 3, axis=-1))):
        content = saved(image, "JPEG", quality=95, progressive=True)
        truth = np.asarray(Pillow.open(io.BytesIO(content))).reshape(32, 48, -1)
        assert (decode_image(content, WHERE, color=False) == truth / np.float32(255)).all()


def test_the_orientation_of_a_photograph_is_ignored() -> None:
    """Texture coordinates mean the pixels as they are stored."""
    image = Pillow.fromarray(DRAW.integers(0, 256, (2, 5, 3)).astype(np.uint8))
    exif = Pillow.Exif()
    exif[0x0112] = 6  # turned by 90 degrees
    for kind in ("JPEG", "PNG", "WEBP"):
        turned = decode_image(saved(image, kind, exif=exif), WHERE)
        assert turned.shape == (2, 5, 3)
        assert (turned == decode_image(saved(image, kind), WHERE)).all()


@pytest.mark.parametrize("channels", [3, 4])
def test_a_lossless_webp_is_kept_whole(channels: int) -> None:
    codes = DRAW.integers(0, 256, (5, 7, channels)).astype(np.uint8)
    content = saved(Pillow.fromarray(codes), "WEBP", lossless=True, exact=True)
    assert (decode_image(content, WHERE, color=False) == codes / np.float32(255)).all()
    colors = decode_image(content, WHERE)
    assert colors[2, 3, 1] == np.float32(as_srgb(codes[2, 3, 1] / 255))


# --- refusals --------------------------------------------------------------------------------


def test_other_formats_are_refused() -> None:
    image = Pillow.new("RGB", (2, 2))
    for content in (b"", b"\x89PN", b"RIFF\0\0\0\0WAVE", b"glTF", saved(image, "TIFF")):
        said = refusal(content)
        assert said == (
            "is none of PNG, JPEG, WebP, BMP, TGA, Radiance .hdr and OpenEXR. Convert it to one of "
            "them."
        )


@pytest.mark.parametrize("kind", ["PNG", "WEBP"])
def test_animations_are_refused(kind: str) -> None:
    frames = [Pillow.new("RGB", (2, 2), color) for color in ("red", "blue")]
    content = saved(frames[0], kind, save_all=True, append_images=frames[1:])
    assert refusal(content) == "is an animation. Save one picture of it."


def test_an_image_that_claims_too_many_pixels_is_refused_before_they_are_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    said = "has 16384 x 16385 pixels, more than glrt reads, 268,435,456. Make it smaller."
    assert refusal(raw_png(16384, 16385, 16, COLOR_ALPHA, b"")) == said
    jpeg = bytearray(saved(Pillow.new("L", (2, 2)), "JPEG"))
    at = jpeg.index(b"\xff\xc0") + 5
    jpeg[at : at + 4] = struct.pack(">HH", 16385, 16384)
    assert refusal(bytes(jpeg)) == said
    size = (16383).to_bytes(3, "little") + (16384).to_bytes(3, "little")
    frames = [Pillow.new("RGB", (2, 2), color) for color in ("red", "blue")]
    webp = saved(frames[0], "WEBP", save_all=True, append_images=frames[1:])
    assert webp[12:16] == b"VP8X"
    vast = webp[:24] + size + webp[30:]
    monkeypatch.setattr(Pillow, "MAX_IMAGE_PIXELS", None)
    assert refusal(vast) == said


@pytest.mark.skipif(PILLOW < (13,), reason="Pillow asks only since 13")
def test_a_webp_beyond_the_limit_of_pillow_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Pillow, "MAX_IMAGE_PIXELS", 2)
    said = refusal(saved(Pillow.new("RGB", (9, 9)), "WEBP"))
    assert said.startswith("has more pixels than Pillow reads of its format. Make it smaller, or")


def test_images_larger_than_pillow_takes_for_bombs_are_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Pillow, "MAX_IMAGE_PIXELS", 2)
    for kind in ("PNG", "JPEG"):
        assert decode_image(saved(Pillow.new("RGB", (9, 9)), kind), WHERE).shape == (9, 9, 3)


def test_a_jpeg_that_goes_over_its_pixels_for_hours_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    content = saved(Pillow.new("L", (64, 64)), "JPEG", progressive=True)
    start, end = content.rindex(b"\xff\xda"), content.rindex(b"\xff\xd9")
    slow = content[:end] + content[start:end] * 40 + content[end:]
    assert decode_image(slow, WHERE).shape == (64, 64, 1)
    monkeypatch.setattr(image_files, "MOST_PIXELS", 64**2)
    assert decode_image(content, WHERE).shape == (64, 64, 1)
    assert refusal(slow).startswith("is damaged: it goes over its pixels 46 times. Copy")


def test_webp_is_refused_where_pillow_lacks_it(monkeypatch: pytest.MonkeyPatch) -> None:
    content = saved(Pillow.new("RGB", (2, 2)), "WEBP")
    monkeypatch.setattr(features, "check", lambda name: False)
    assert refusal(content).startswith("is WebP, which Pillow cannot read here. Convert it to PNG")


# --- faults ----------------------------------------------------------------------------------

NOISE = Pillow.fromarray(DRAW.integers(0, 256, (16, 16, 3)).astype(np.uint8))
WHOLE: dict[str, Callable[[], bytes]] = {
    "PNG": lambda: saved(NOISE, "PNG"),
    "PNG of 16 bits": lambda: png(codes_of(COLOR, np.uint16), COLOR, adam7=True),
    "JPEG": lambda: saved(NOISE, "JPEG", progressive=True),
    "WebP": lambda: saved(NOISE, "WEBP", lossless=True),
    "OpenEXR": lambda: exr({name: np.ones((9, 9), np.float32) for name in "RGB"}),
    "flat Radiance": lambda: flat_hdr(DRAW.integers(0, 256, (9, 9, 4)).astype(np.uint8)),
    "Radiance": lambda: rle_hdr(DRAW.integers(0, 3, (9, 9, 4)).astype(np.uint8)),
}


@pytest.mark.parametrize("kind", WHOLE)
def test_an_image_that_is_cut_off_is_refused(kind: str) -> None:
    content = WHOLE[kind]()
    for length in range(60, len(content) * 3 // 4, max(1, len(content) // 40)):
        assert refusal(content[:length]).startswith("is damaged: "), length


@pytest.mark.parametrize("kind", WHOLE)
def test_an_image_with_wrong_bytes_is_read_or_refused(kind: str) -> None:
    def told(content: bytes) -> str:
        try:
            pixels = decode_image(content, WHERE)
        except SceneError as error:
            said = str(error)
            return (
                "refused"
                if said.startswith(f"{WHERE}: this image ") and said.isprintable()
                else "badly"
            )
        assert pixels.dtype == np.float32
        assert pixels.ndim == 3
        assert np.isfinite(pixels).all()
        return "read"

    ends = hunt(broken(WHOLE[kind]()), told, 150, 1)
    assert ends["refused"] > 10
    assert "badly" not in ends
