"""OpenEXR files as linear values: what is read of them, and every refusal."""

import struct
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR  # type: ignore[import-not-found]
import pytest

from glrt.core.errors import RenderError
from glrt.scene.images import float_images
from glrt.scene.images.image_files import decode_image
from tests.support.image_bytes import WHERE, exr, exr_of_parts, exr_written, refusal
from tests.support.images import picture

DRAW = np.random.default_rng(7)
PLANE = np.ones((2, 3), np.float32)
RGB = dict.fromkeys("RGB", PLANE)


@pytest.mark.parametrize("names", ["RGB", "RGBA", "Y", "YA"])
@pytest.mark.parametrize("dtype", [np.float16, np.float32])
def test_an_exr_is_read_as_it_is_stored(names: str, dtype: type) -> None:
    planes: dict[str, Any] = {name: DRAW.random((5, 7)).astype(dtype) for name in names}
    planes["Z"] = np.full((5, 7), np.inf, dtype)
    for color in (True, False):
        pixels = decode_image(exr(planes), WHERE, color)
        assert pixels.dtype == np.float32
        assert (pixels == np.stack([planes[name] for name in names], axis=-1)).all()


def test_channels_of_different_precision_and_tiles_are_read() -> None:
    planes = {"R": np.half(0.1), "G": np.single(0.1), "B": np.single(0.3)}
    full = {name: np.full((40, 50), value) for name, value in planes.items()}
    content = exr(full, type=OpenEXR.tiledimage, tiles=OpenEXR.TileDescription())
    assert (decode_image(content, WHERE) == np.array([*planes.values()], np.float32)).all()


def test_a_picture_of_glrt_is_read(tmp_path: Path) -> None:
    image = picture()
    image.radiance[image.radiance < 0] = 7
    image.radiance[~np.isfinite(image.radiance)] = 8
    image.save(tmp_path / "a.exr")
    assert (decode_image((tmp_path / "a.exr").read_bytes(), WHERE) == image.radiance).all()


def test_light_that_is_none_is_refused_with_its_number_and_place() -> None:
    planes = {name: np.ones((4, 5), np.float32) for name in "RGB"}
    planes["G"][2, 3] = -0.5
    planes["B"][3, :2] = np.nan
    said = refusal(exr(planes))
    assert said == (
        "has values that are negative or not finite, 3 of them: the first is -0.5, in row 2 and "
        "column 3 of G, counted from 0 at the top left. Repair the image."
    )
    data = refusal(exr(planes), color=False)
    assert data.startswith("has values that are not finite, 2 of them: the first is nan, in row 3")
    planes["B"][:] = 1
    assert decode_image(exr(planes), WHERE, color=False)[2, 3, 1] == -0.5


def test_what_filters_leave_below_0_is_black() -> None:
    """This holds up to a thousandth of the light: maps that come with Blender have such pixels."""
    planes = {name: np.ones((20, 30), np.float32) for name in "RGB"}
    planes["G"][2, 3] = -0.5
    read = decode_image(exr(planes), WHERE)
    assert read[2, 3, 1] == 0
    assert (np.delete(read.reshape(-1), (2 * 30 + 3) * 3 + 1) == 1).all()
    planes["G"][2, 3:7] = -0.5
    assert refusal(exr(planes)).startswith("has values that are negative or not finite, 4 of them")


def test_exr_files_that_are_no_flat_image_are_refused() -> None:
    plane = np.ones((2, 3), np.float32)
    deep = np.empty((2, 3), object)
    for place in np.ndindex(2, 3):
        deep[place] = np.ones(2, np.float32)
    kind = {"type": OpenEXR.deepscanline, "compression": OpenEXR.ZIPS_COMPRESSION}
    assert refusal(exr(dict.fromkeys("RGB", deep), **kind)).startswith("is deep. Flatten it")
    parts = [OpenEXR.Part({}, {"Y": plane}, name) for name in ("left", "right")]
    assert refusal(exr_of_parts(parts)) == "has 2 parts. Save one of them."
    whole = dict.fromkeys("RGB", plane.astype(np.uint32))
    assert refusal(exr(whole)) == "has channels of whole numbers. Save it in half or float."
    said = refusal(exr({"Z": plane, "left.R": plane}))
    assert said == "needs channels R, G and B, or Y; has Z, left.R. Save it with one of these."


def test_luminance_with_chroma_of_half_the_size_is_refused() -> None:
    import Imath  # type: ignore[import-untyped]

    def write(path: str) -> None:
        header = OpenEXR.Header(4, 4)
        half = Imath.PixelType(Imath.PixelType.HALF)
        header["channels"] = {"Y": Imath.Channel(half)} | dict.fromkeys(
            ("RY", "BY"), Imath.Channel(half, 2, 2)
        )
        file = OpenEXR.OutputFile(path, header)
        file.writePixels({"Y": bytes(32), "RY": bytes(8), "BY": bytes(8)})
        file.close()

    said = "has channels of luminance and chroma. Save it as R, G and B."
    assert refusal(exr_written(write)) == said


def test_a_part_of_a_larger_picture_is_refused() -> None:
    for low, high in (((0, 0), (9, 9)), ((1, 0), (3, 1)), ((0, 0), (1, 1))):
        window = (np.array(low, np.int32), np.array(high, np.int32))
        said = refusal(exr(RGB, displayWindow=window))
        assert said.startswith("is a part of a larger picture, or larger than it: its data window")
    window = (np.array((5, -7), np.int32), np.array((7, -6), np.int32))
    moved = exr(RGB, displayWindow=window, dataWindow=window)
    assert decode_image(moved, WHERE).shape == (2, 3, 3)


def test_colours_in_other_primaries_are_refused_and_data_are_not() -> None:
    ap1 = (0.713, 0.293, 0.165, 0.83, 0.128, 0.044, 0.32168, 0.33767)
    content = exr(RGB, chromaticities=ap1)
    said = refusal(content)
    assert said.startswith("has other primaries than linear sRGB, with red at (0.713, 0.293) and")
    assert said.endswith("Convert it to linear sRGB (Rec. 709).")
    assert decode_image(content, WHERE, color=False).shape == (2, 3, 3)
    rec_709 = (0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329)
    assert decode_image(exr(RGB, chromaticities=rec_709), WHERE).shape == (2, 3, 3)


def claiming(content: bytes, name: bytes, *corners: int) -> bytes:
    """The content with other corners of a window in its header."""
    window = name + b"\0box2i\0" + struct.pack("<i", 16)
    at = content.index(window) + len(window)
    return content[:at] + struct.pack("<4i", *corners) + content[at + 16 :]


def test_an_exr_that_claims_too_many_pixels_is_refused_by_its_header() -> None:
    vast = claiming(exr(RGB), b"dataWindow", 0, 0, 16383, 16384)
    assert refusal(vast).startswith("has 16384 x 16385 pixels, more than glrt reads, 268,435,456")
    assert refusal(claiming(exr(RGB), b"dataWindow", 0, 0, -1, 9)).startswith("is damaged")


def test_an_exr_of_many_large_channels_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    content = exr({**RGB, **{f"layer{i}.R": PLANE for i in range(30)}})
    assert decode_image(content, WHERE).shape == (2, 3, 3)
    monkeypatch.setattr(float_images, "MOST_PIXELS", 12)
    said = "has 33 channels of 3 x 2 pixels, more than glrt reads. Save R, G and B alone."
    assert refusal(content) == said


def test_pixels_that_cannot_be_decoded_are_refused() -> None:
    smooth = np.add.outer(np.arange(64.0), np.arange(40.0)).astype(np.float32)
    content = exr(dict.fromkeys("RGB", smooth), compression=OpenEXR.ZIP_COMPRESSION)
    middle = len(content) // 2
    for broken in (content[:-1], content[:middle] + bytes(99) + content[middle + 99 :]):
        said = refusal(broken)
        assert said.startswith("is damaged: ")
        assert "part index" not in said


def test_a_disk_without_room_is_no_fault_of_the_image(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    content = exr(RGB)
    monkeypatch.setattr(Path, "write_bytes", refuse)
    with pytest.raises(RenderError, match=r"Cannot copy .*: No space left on device\. Free some"):
        decode_image(content, WHERE)
