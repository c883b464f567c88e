"""Images in files as arrays of linear values: PNG, JPEG, WebP, BMP, TGA, Radiance and OpenEXR.

All but the last two hold codes: colours are decoded by the sRGB curve, and data are scaled to 0..1.
Their gAMA chunks and colour profiles are ignored, as in glTF. Radiance and OpenEXR hold linear
values.
"""

import io
import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import SceneError
from glrt.scene.images.codes import Codes, Texels, halves, linear
from glrt.scene.images.float_images import (
    MOST_PIXELS,
    Pixels,
    RefusedImageError,
    check_size,
    damaged,
    decode_exr,
    reading,
)
from glrt.scene.images.metadata import bare_jpeg, bare_png, frames_of_png
from glrt.scene.images.radiance import decode_hdr

BRIGHTEST = 65_504.0  # of a texture: the largest half float
_MOST_SCANS = 16  # of a JPEG file with MOST_PIXELS: a scan of a few bytes goes over all pixels


def decode_image(content: bytes, where: str, color: bool = True) -> Pixels:
    """Return the image in the bytes of a file, (H, W, C) float32, linear, row 0 on top.

    C is 1 for grey, 2 for grey and alpha, 3 for R, G, B and 4 for R, G, B, alpha, as stored. A
    palette becomes the colours that it stands for, and a transparent colour of a PNG becomes alpha.
    8 and 16 bits are kept whole. Alpha is linear. Colours are those of the file, not multiplied by
    alpha (PNG, WebP) or multiplied (OpenEXR). The inks of a CMYK image filter white: red is
    (1 - C) (1 - K). Metadata are not read: the EXIF orientation is ignored, since texture
    coordinates mean the pixels as stored. Radiance values are divided by the exposures in their
    header.

    `color` says that codes are colours in sRGB, which become linear in Rec. 709 primaries; else
    they are data, code / 255 or code / 65535. Float values are taken as they are; those of colours
    must not be negative.

    The content decides the format; no name plays a part. `where` begins messages: the scene file,
    the key and the file. Raises `SceneError` for another format, a damaged file, more than 16384 x
    16384 pixels, values that are not finite or negative colours, an animation, Radiance XYZE, or
    an OpenEXR file that is not one flat image of R, G, B, or Y.
    """
    stored = _stored(content, where, color)
    return stored if stored.dtype == np.float32 else linear(stored, color)


def decode_texels(content: bytes, where: str, color: bool = True) -> Texels:
    """Return an image as texels, (H, W, 4) float16: the values of `decode_image`, or grey as R, G
    and B, and 1 for the alpha that it lacks.

    Raises `SceneError` as `decode_image` does, and for float values that float16 cannot hold.
    """
    stored = _stored(content, where, color)
    if stored.dtype == np.uint8:
        return halves(stored, color)
    pixels = stored if stored.dtype == np.float32 else linear(stored, color)
    check_brightness(pixels, BRIGHTEST, where)
    found = np.ones((*pixels.shape[:2], 4), np.float16)
    channels = pixels.shape[2]
    found[..., :3] = pixels[..., :1] if channels < 3 else pixels[..., :3]
    if channels in (2, 4):
        found[..., 3] = pixels[..., -1]
    return found


def check_brightness(pixels: Pixels, most: float, where: str) -> None:
    """Raise SceneError for an image with a value above `most`."""
    if pixels.max() > most:
        raise SceneError(f"{where}: this image is brighter than {most:,g}; scale it down.")


def _stored(content: bytes, where: str, color: bool) -> NDArray[Any]:
    """Return codes, (H, W, C) uint8 or uint16, or linear values in float32."""
    try:
        for begin, decode in _DECODERS.items():
            if re.match(begin, content, re.DOTALL):
                return decode(content)
        for begin, read in _FLOAT_DECODERS.items():
            if re.match(begin, content, re.DOTALL):
                return read(content, color)
        raise RefusedImageError(
            "is none of PNG, JPEG, WebP, BMP, TGA, Radiance .hdr and OpenEXR. Convert it to one "
            "of them"
        )
    except RefusedImageError as refused:
        raise SceneError(f"{where}: this image {refused}.") from None


# --- codes ----------------------------------------------------------------------


def _decode_png(content: bytes) -> Codes:
    from PIL.PngImagePlugin import PngImageFile

    if frames_of_png(content) > 1:
        raise RefusedImageError(_ANIMATION)
    bare = bare_png(content)
    with _reading():
        return _png_codes(lambda: PngImageFile(io.BytesIO(bare)))


def _decode_jpeg(content: bytes) -> Codes:
    from PIL.JpegImagePlugin import JpegImageFile

    with _reading(), JpegImageFile(io.BytesIO(bare_jpeg(content))) as image:
        check_size(*image.size)
        scans = content.count(b"\xff\xda")
        if scans * image.width * image.height > _MOST_SCANS * MOST_PIXELS:
            raise damaged(f"it goes over its pixels {scans:,} times")
        return _planes(image.convert("RGB") if image.mode == "CMYK" else image)


def _decode_webp(content: bytes) -> Codes:
    from PIL import features
    from PIL.WebPImagePlugin import WebPImageFile

    if not features.check("webp"):
        raise RefusedImageError("is WebP, which Pillow cannot read here. Convert it to PNG")
    with _reading(), WebPImageFile(io.BytesIO(content)) as image:
        check_size(*image.size)
        if image.is_animated:
            raise RefusedImageError(_ANIMATION)
        return _planes(image)


def _decode_bmp(content: bytes) -> Codes:
    from PIL.BmpImagePlugin import BmpImageFile

    return _plain(lambda: BmpImageFile(io.BytesIO(content)))


def _decode_tga(content: bytes) -> Codes:
    from PIL.TgaImagePlugin import TgaImageFile

    return _plain(lambda: TgaImageFile(io.BytesIO(content)))


def _plain(opened: Callable[[], Any]) -> Codes:
    """Read an image of 8 bits a channel, perhaps with a palette."""
    with _reading(), opened() as image:
        check_size(*image.size)
        is_plain = image.mode in ("L", "LA", "RGB", "RGBA")
        return _planes(image if is_plain else image.convert("RGB"))


@contextmanager
def _reading() -> Iterator[None]:
    """Apply `reading`, and silence Pillow's warnings of metadata that are of no use here."""
    from PIL.Image import DecompressionBombError

    with reading(), warnings.catch_warnings(action="ignore"):
        try:
            yield
        except DecompressionBombError:  # from WebP alone, and for fewer pixels than are read here
            raise RefusedImageError(
                "has more pixels than Pillow reads of its format. Make it smaller, or convert it "
                "to PNG"
            ) from None


_ANIMATION = "is an animation. Save one picture of it"


def _png_codes(opened: Callable[[], Any]) -> Codes:
    with opened() as image:
        check_size(*image.size)
        stored = image.tile[0].args if image.tile else ""
        if stored in _PARTS_OF_16_BITS:
            return _with_key(_sixteen_bits(opened, stored), image, 1)
        if image.mode == "P":
            return _planes(image.convert("RGBA" if image.has_transparency_data else "RGB"))
        planes = _planes(image.convert("L") if image.mode == "1" else image)
        return _with_key(planes, image, {"L;2": 85, "L;4": 17}.get(stored, 1))


# Layouts by which Pillow unpacks pixels of 16 bits into bytes: it has no image for them, and keeps
# the upper byte; read as if little-endian, it keeps the lower one. Grey with alpha has the four
# bytes of a colour with alpha.
_PARTS_OF_16_BITS = {
    "RGB;16B": ("RGB;16B", "RGB;16L"),
    "RGBA;16B": ("RGBA;16B", "RGBA;16L"),
    "LA;16B": ("RGBA",),
}


def _sixteen_bits(opened: Callable[[], Any], stored: str) -> Codes:
    parts = []
    for layout in _PARTS_OF_16_BITS[stored]:
        with opened() as image:
            image.tile = [tile._replace(args=layout) for tile in image.tile]
            parts.append(_planes(image))
    if len(parts) == 1:
        return parts[0].view(">u2").astype(np.uint16)
    return parts[0].astype(np.uint16) << 8 | parts[1]


def _with_key(codes: Codes, image: Any, scale: int) -> Codes:
    """Add alpha if one colour is transparent; `scale` leads from that colour's codes to these."""
    if "transparency" not in image.info:
        return codes
    key = np.multiply(image.info["transparency"], scale)
    opaque = (codes != key).any(axis=2, keepdims=True) * np.iinfo(codes.dtype).max
    return np.concatenate([codes, opaque.astype(codes.dtype)], axis=2)


def _planes(image: Any) -> Codes:
    codes = np.asarray(image)
    return codes[:, :, None] if codes.ndim == 2 else codes


# How a file of each format begins.
_DECODERS: dict[bytes, Callable[[bytes], Codes]] = {
    rb"\x89PNG\r\n\x1a\n": _decode_png,
    rb"\xff\xd8\xff": _decode_jpeg,
    rb"RIFF....WEBP": _decode_webp,
    rb"BM....\0\0\0\0": _decode_bmp,
    rb".[\0\1][\1-\3\x09-\x0b]": _decode_tga,  # TGA has no mark of its own
}
_FLOAT_DECODERS: dict[bytes, Callable[[bytes, bool], Pixels]] = {
    rb"#\?": decode_hdr,
    rb"\x76\x2f\x31\x01": decode_exr,
}
