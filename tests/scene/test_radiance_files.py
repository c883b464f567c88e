"""Radiance .hdr files as linear values, against files written by hand."""

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.scene.images import radiance
from glrt.scene.images.image_files import decode_image
from tests.support.image_bytes import WHERE, flat_hdr, hdr, refusal, rle_hdr

DRAW = np.random.default_rng(5)

Bytes = NDArray[np.uint8]


def radiance_of(rgbe: Bytes) -> NDArray[np.float64]:
    """Plain numbers, pixel by pixel."""
    return np.array(
        [
            [
                [int(m) * 2.0 ** (int(e) - 136) if e else 0.0 for m in (r, g, b)]
                for r, g, b, e in row
            ]
            for row in rgbe
        ]
    )


def pixels_of(height: int, width: int) -> Bytes:
    """Any mantissas and exponents, without pixels that mean a run or the start of a line."""
    rgbe = DRAW.integers(3, 256, (height, width, 4)).astype(np.uint8)
    rgbe[DRAW.random((height, width)) < 0.2, 3] = 0
    return rgbe


def test_pixels_of_a_radiance_file_are_their_closed_form() -> None:
    rgbe = np.array(
        [[[128, 64, 32, 129], [255, 1, 0, 255], [255, 2, 1, 1], [9, 9, 9, 0]]], np.uint8
    )
    pixels = decode_image(flat_hdr(rgbe), WHERE)
    assert pixels.dtype == np.float32
    assert pixels[0, 0].tolist() == [1, 0.5, 0.25]
    assert pixels[0, 1].tolist() == [255 * 2.0**119, 2.0**119, 0]
    assert pixels[0, 2].tolist() == [255 * 2.0**-135, 2.0**-134, 2.0**-135]
    assert pixels[0, 3].tolist() == [0, 0, 0]


@pytest.mark.parametrize("width", [1, 7, 8, 200])
def test_flat_files_are_read(width: int) -> None:
    rgbe = pixels_of(5, width)
    for color in (True, False):
        assert (decode_image(flat_hdr(rgbe), WHERE, color) == radiance_of(rgbe)).all()


@pytest.mark.parametrize("width", [8, 300])
def test_files_of_runs_are_read(width: int) -> None:
    rgbe = pixels_of(5, width)
    rgbe[1] = rgbe[1, 0]
    rgbe[2, width // 3 :, 2:] = 77
    content = rle_hdr(rgbe)
    assert len(content) < len(flat_hdr(rgbe)) or width == 8
    assert (decode_image(content, WHERE) == radiance_of(rgbe)).all()


def test_a_narrow_line_is_no_line_of_runs_though_it_begins_like_one() -> None:
    rgbe = np.full((1, 7, 4), 130, np.uint8)
    rgbe[0, 0] = 2, 2, 0, 7
    assert (decode_image(flat_hdr(rgbe), WHERE) == radiance_of(rgbe)).all()


def test_files_of_repeated_pixels_are_read() -> None:
    """The older encoding: how often the last pixel is repeated, its low byte first."""
    pixel, other, third = bytes([10, 20, 30, 130]), bytes([40, 50, 60, 131]), bytes([1, 1, 2, 128])
    line = pixel + b"\1\1\1\x2b\1\1\1\1" + other + b"\1\1\1\2" + third
    length = 1 + 0x2B + 256 + 1 + 2 + 1
    pixels = decode_image(hdr(f"-Y 2 +X {length}", line + third * length), WHERE)
    expected = np.frombuffer(pixel * 300 + other * 3 + third, np.uint8).reshape(1, length, 4)
    assert (pixels[0] == radiance_of(expected)[0]).all()
    assert (pixels[1] == radiance_of(expected)[0, -1]).all()


def test_lines_of_each_encoding_may_follow_each_other() -> None:
    rgbe = pixels_of(2, 9)
    runs_of_one = rle_hdr(rgbe[:1])
    content = runs_of_one.replace(b"-Y 1", b"-Y 2") + rgbe[1].tobytes()
    assert (decode_image(content, WHERE) == radiance_of(rgbe)).all()


@pytest.mark.parametrize("first", ["-Y", "+Y", "-X", "+X"])
@pytest.mark.parametrize("second", ["-", "+"])
def test_every_orientation_has_row_0_on_top(first: str, second: str) -> None:
    """The pixel whose red is 9 lies at the top left, whichever pixel the file begins with."""
    truth = radiance_of(np.arange(3, 27, dtype=np.uint8).reshape(2, 3, 4))
    stored = np.arange(3, 27, dtype=np.uint8).reshape(2, 3, 4)
    by_columns = first[1] == "X"
    up = "+" in (second if by_columns else first)
    left = "-" in (first if by_columns else second)
    stored = stored[::-1] if up else stored
    stored = stored[:, ::-1] if left else stored
    stored = stored.swapaxes(0, 1) if by_columns else stored
    size = f"{first} {stored.shape[0]} {second}{'Y' if by_columns else 'X'} {stored.shape[1]}"
    assert (decode_image(hdr(size, stored.tobytes()), WHERE) == truth).all()


def test_exposures_are_undone_but_those_of_the_files_it_was_made_from() -> None:
    rgbe = np.array([[[128, 128, 128, 129]]], np.uint8)
    lines = ("EXPOSURE=4", "EXPOSURE= 0.5", "COLORCORR=1 2 4", "\tEXPOSURE=64")
    assert decode_image(flat_hdr(rgbe, *lines), WHERE)[0, 0].tolist() == [0.5, 0.25, 0.125]


@pytest.mark.parametrize(
    "value", ["0", "", "nan", "inf", "bright", "1 2", "-1", "1e31", "1e-32", "1e308", "1 1 0"]
)
def test_an_exposure_that_no_pixel_can_have_says_nothing(value: str) -> None:
    """FreeImage has written EXPOSURE=0 (OpenCV's issue 4885)."""
    rgbe = np.array([[[128, 128, 128, 129]]], np.uint8)
    lines = ("EXPOSURE=4", f"EXPOSURE={value}", f"COLORCORR={value}")
    assert decode_image(flat_hdr(rgbe, *lines), WHERE)[0, 0].tolist() == [0.25] * 3


def test_a_header_without_its_format_is_rgbe_and_xyze_is_refused() -> None:
    content = flat_hdr(np.full((1, 1, 4), 128, np.uint8))
    bare = content.replace(b"#?RADIANCE", b"#?RGBE").replace(b"FORMAT=32-bit_rle_rgbe\n", b"")
    assert decode_image(bare, WHERE)[0, 0].tolist() == [0.5, 0.5, 0.5]
    xyze = content.replace(b"rle_rgbe", b"rle_xyze")
    assert refusal(xyze) == "has pixels in 32-bit_rle_xyze, not in RGBE. Convert it to RGBE."


HDR_FAULTS: dict[str, tuple[str, bytes, str]] = {
    "no size": ("", b"", "its header does not say how large it is"),
    "one axis twice": ("-Y 2 +Y 2", bytes(16), "its header does not say how large it is"),
    "no pixels": ("-Y 0 +X 2", b"", "it has no pixels"),
    "cut off": ("-Y 3 +X 2", b"\4" * 23, "it ends in line 2 of 3"),
    "another width": ("-Y 1 +X 8", b"\2\2\0\x09" + bytes(40), "a line has another length"),
    "a long run": ("-Y 1 +X 8", b"\2\2\0\x08\x89\1" + bytes(40), "a run passes the end"),
    "long bytes": ("-Y 1 +X 8", b"\2\2\0\x08\x09" + bytes(40), "a run passes the end"),
    "an empty run": ("-Y 1 +X 8", b"\2\2\0\x08\0" + bytes(40), "a run passes the end"),
    "a run of nothing": ("-Y 1 +X 2", b"\1\1\1\2" + bytes(8), "a run passes the end"),
    "a vast run": ("-Y 1 +X 7", b"\4\4\4\4" + b"\1\1\1\0" * 9 + b"\1\1\1\1", "a run passes"),
}


@pytest.mark.parametrize("fault", HDR_FAULTS)
def test_damaged_radiance_files_are_refused(fault: str) -> None:
    size, data, says = HDR_FAULTS[fault]
    assert refusal(hdr(size, data)).startswith(f"is damaged: {says}")


def test_a_radiance_file_that_claims_too_many_pixels_is_refused() -> None:
    assert refusal(hdr("-Y 16385 +X 16384", b"")).startswith("has 16384 x 16385 pixels, more than")


def test_radiance_beyond_float32_is_refused() -> None:
    rgbe = np.array([[[1, 2, 3, 128], [1, 255, 3, 255]]], np.uint8)
    assert np.isfinite(decode_image(flat_hdr(rgbe, "EXPOSURE=0.5"), WHERE)).all()
    said = refusal(flat_hdr(rgbe, "EXPOSURE=0.25"))
    assert said.startswith(
        "has values that are negative or not finite, 1 of them: the first is inf"
    )
    assert "in row 0 and column 1 of G" in said


@pytest.mark.parametrize("together", [1, 100, 1 << 20])
def test_lines_of_both_kinds_may_follow_each_other(
    together: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Some lines by runs and some by pixels, decoded one by one, by threes and all at once."""
    monkeypatch.setattr(radiance, "_AT_ONCE", together)
    rgbe = np.random.default_rng(6).integers(5, 8, (9, 8, 4)).astype(np.uint8)
    rgbe[..., 3] = 130
    lines = [rle_hdr(row[None]).split(b"+X 8\n")[1] for row in rgbe]
    lines[2], lines[7] = rgbe[2].tobytes(), rgbe[7].tobytes()
    found = decode_image(hdr("-Y 9 +X 8", b"".join(lines)), WHERE)
    assert (found == decode_image(flat_hdr(rgbe), WHERE)).all()


def test_a_file_too_short_for_its_lines_takes_no_memory() -> None:
    said = refusal(hdr("-Y 16384 +X 16384", bytes(40)))
    assert said.startswith("is damaged: it has 40 bytes for 16,384 lines")


@pytest.mark.parametrize("blank", [b" ", b"\t", b"\r"])
def test_a_blank_in_the_empty_line_ends_the_header_too(blank: bytes) -> None:
    content = flat_hdr(np.full((2, 3, 4), 128, np.uint8)).replace(b"\n\n", b"\n" + blank + b"\n")
    assert (decode_image(content, WHERE) == 0.5).all()
