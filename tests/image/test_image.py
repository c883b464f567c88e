"""Image files: every bit comes back, the recipe with it, and what is not an image is refused."""

import dataclasses
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR  # type: ignore[import-not-found]
import pytest
from numpy.typing import NDArray
from PIL import Image as Pillow
from PIL.PngImagePlugin import PngInfo

from glrt.core.errors import SceneError, UsageError
from glrt.image.image import Image, read_recipe
from glrt.image.recipe import Recipe
from glrt.image.tonemap import expose_and_encode
from glrt.settings import ToneMap
from tests.support.images import picture, recipe, same_bits

odd_sizes = pytest.mark.parametrize("size", [(1, 1), (5, 7), (3, 257)])  # rows, columns


@pytest.fixture
def image() -> Image:
    return picture()


def exr(path: Path, channels: dict[str, NDArray[Any]], **header: Any) -> None:
    """An EXR file by another hand."""
    OpenEXR.File({"type": OpenEXR.scanlineimage, **header}, channels).write(str(path))


@odd_sizes
def test_exr_gives_back_every_bit(tmp_path: Path, size: tuple[int, int]) -> None:
    image = picture(*size)
    image.save(tmp_path / "x.exr")
    again = Image.load(tmp_path / "x.exr")
    assert same_bits(again.radiance, image.radiance)
    assert same_bits(again.stderr, image.stderr)
    assert again.samples == 12
    assert again.recipe == image.recipe


@odd_sizes
def test_npy_gives_back_every_bit(tmp_path: Path, size: tuple[int, int]) -> None:
    image = picture(*size)
    image.save(tmp_path / "x.npy")
    assert same_bits(np.load(tmp_path / "x.npy"), image.radiance)


def test_unknown_stderr_comes_back_unknown(tmp_path: Path, image: Image) -> None:
    unknown = np.full_like(image.stderr, np.nan)
    dataclasses.replace(image, stderr=unknown).save(tmp_path / "x.exr")
    again = Image.load(tmp_path / "x.exr")
    assert same_bits(again.stderr, unknown)
    assert again.error is None


def test_arrays_that_are_not_contiguous_are_saved_as_they_look(
    tmp_path: Path, image: Image
) -> None:
    flipped = dataclasses.replace(image, radiance=image.radiance[::-1, ::-1])
    flipped.save(tmp_path / "x.exr")
    assert same_bits(Image.load(tmp_path / "x.exr").radiance, flipped.radiance)


def test_an_exr_holds_float_channels_by_the_names_that_others_know(
    tmp_path: Path, image: Image
) -> None:
    image.save(tmp_path / "x.exr")
    with OpenEXR.File(str(tmp_path / "x.exr"), separate_channels=True) as file:
        planes = {name: channel.pixels for name, channel in file.channels().items()}
        assert file.header()["compression"] == OpenEXR.ZIP_COMPRESSION
    assert set(planes) == {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"}
    assert same_bits(planes["G"], image.radiance[..., 1])
    assert same_bits(planes["stderr.B"], image.stderr[..., 2])


@odd_sizes
@pytest.mark.parametrize("tonemap", ["none", "agx"])
def test_png_shows_exposed_and_encoded_radiance(
    tmp_path: Path, size: tuple[int, int], tonemap: ToneMap
) -> None:
    image = picture(*size)
    image.save(tmp_path / "x.png", exposure=1.5, tonemap=tonemap)
    with Pillow.open(tmp_path / "x.png") as file:
        assert file.mode == "RGB"
        pixels = np.asarray(file)
    assert np.array_equal(pixels, expose_and_encode(image.radiance, 1.5, tonemap))


def test_png_takes_exposure_and_curve_from_the_recipe(tmp_path: Path) -> None:
    image = picture(exposure=-2.0, tonemap="aces")
    image.save(tmp_path / "x.png")
    with Pillow.open(tmp_path / "x.png") as file:
        pixels = np.asarray(file)
    assert np.array_equal(pixels, expose_and_encode(image.radiance, -2.0, "aces"))
    assert not np.array_equal(pixels, expose_and_encode(image.radiance, 0.0, "neutral"))


@pytest.mark.parametrize("suffix", [".exr", ".npy"])
def test_exposure_never_touches_radiance(tmp_path: Path, image: Image, suffix: str) -> None:
    image.save(tmp_path / f"a{suffix}", exposure=3.0, tonemap="aces")
    image.save(tmp_path / f"b{suffix}")
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


def test_an_unknown_tone_curve_is_refused(tmp_path: Path, image: Image) -> None:
    with pytest.raises(UsageError, match=r"'filmic'.*none, aces, agx, neutral"):
        image.save(tmp_path / "x.png", tonemap="filmic")  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


def test_notebooks_show_the_png(tmp_path: Path, image: Image) -> None:
    image.save(tmp_path / "x.png")
    with (
        Pillow.open(tmp_path / "x.png") as saved,
        Pillow.open(BytesIO(image._repr_png_())) as shown,
    ):
        assert np.array_equal(np.asarray(saved), np.asarray(shown))


@pytest.mark.parametrize("name", ["x.exr", "x.png", "UPPER.PNG", "Mixed.Exr"])
def test_pictures_carry_their_recipe(tmp_path: Path, image: Image, name: str) -> None:
    image.save(tmp_path / name)
    assert read_recipe(tmp_path / name) == image.recipe


@pytest.mark.parametrize("name", ["x.exr", "x.png"])
def test_recipes_of_the_largest_scenes_fit(tmp_path: Path, image: Image, name: str) -> None:
    assert image.recipe is not None
    long = image.recipe.model_copy(update={"renderer": "x" * 10_000_000})
    dataclasses.replace(image, recipe=long).save(tmp_path / name)
    assert read_recipe(tmp_path / name) == long


def test_the_recipe_of_a_huge_png_is_read_without_its_pixels(tmp_path: Path) -> None:
    wide = Image(np.zeros((1, 1, 3), np.float32), np.zeros((1, 1, 3), np.float32), 1, recipe())
    png = wide._repr_png_()
    header = png[:16] + (16384).to_bytes(4, "big") * 2 + png[24:29]
    header += _crc(header[12:29])
    (tmp_path / "x.png").write_bytes(header + png[33:])
    assert read_recipe(tmp_path / "x.png") == wide.recipe


def _crc(chunk: bytes) -> bytes:
    import zlib

    return zlib.crc32(chunk).to_bytes(4, "big")


def test_the_error_of_an_image_is_that_of_its_statistics() -> None:
    radiance, stderr = np.full((2, 2, 2, 3), [[[[2.0]]], [[[1.0]]]], np.float32)
    assert Image(radiance, stderr, 4).error == pytest.approx(0.5 / np.sqrt(1.01))


@pytest.mark.parametrize(
    "pixels", [np.zeros((2, 2, 3)), np.zeros((2, 2, 4), np.float32), np.zeros((2, 3), np.float32)]
)
def test_what_is_no_image_is_refused(pixels: Any) -> None:
    with pytest.raises(ValueError, match="not an image"):
        Image(pixels, pixels, 1)


def test_radiance_and_stderr_have_one_size() -> None:
    with pytest.raises(ValueError, match="differ"):
        Image(np.zeros((2, 2, 3), np.float32), np.zeros((2, 3, 3), np.float32), 1)


# Files of other programs


@pytest.mark.parametrize("dtype", [np.float16, np.float32])
def test_exr_files_of_others_have_radiance_alone(tmp_path: Path, dtype: type) -> None:
    pixels: NDArray[Any] = np.random.default_rng(2).random((3, 4, 4)).astype(dtype)
    exr(tmp_path / "x.exr", {"RGBA": pixels})
    image = Image.load(tmp_path / "x.exr")
    assert same_bits(image.radiance, pixels[..., :3].astype(np.float32))
    assert np.isnan(image.stderr).all()
    assert (image.samples, image.recipe) == (0, None)


def test_exr_files_without_colours_are_refused_by_the_names_of_their_channels(
    tmp_path: Path,
) -> None:
    exr(tmp_path / "x.exr", {"depth.Z": np.zeros((2, 2), np.float32)})
    with pytest.raises(UsageError, match=r"x\.exr.*R, G and B.*depth\.Z"):
        Image.load(tmp_path / "x.exr")


def test_names_that_a_terminal_would_obey_are_reported_without_their_commands(
    tmp_path: Path,
) -> None:
    exr(tmp_path / "x.exr", {"\x1b[2J\n": np.zeros((2, 2), np.float32)})
    with pytest.raises(UsageError) as caught:
        Image.load(tmp_path / "x.exr")
    assert "[2J" in str(caught.value)
    assert str(caught.value).isprintable()


def test_a_foreign_picture_has_no_recipe(tmp_path: Path) -> None:
    exr(tmp_path / "x.exr", {"RGB": np.zeros((2, 2, 3), np.float32)})
    Pillow.new("RGB", (2, 2)).save(tmp_path / "x.png")
    for name in ("x.exr", "x.png"):
        with pytest.raises(UsageError, match=f"{name}.*no recipe"):
            read_recipe(tmp_path / name)


def test_damaged_metadata_are_named(tmp_path: Path) -> None:
    exr(tmp_path / "x.exr", {"RGB": np.zeros((2, 2, 3), np.float32)}, glrt='{"scene": ')
    exr(tmp_path / "number.exr", {"RGB": np.zeros((2, 2, 3), np.float32)}, glrt=7)
    metadata = PngInfo()
    metadata.add_text("glrt", "by hand")
    Pillow.new("RGB", (2, 2)).save(tmp_path / "x.png", pnginfo=metadata)
    for name in ("x.exr", "number.exr", "x.png"):
        with pytest.raises(SceneError, match=f"{name}: the recipe in this picture is damaged"):
            read_recipe(tmp_path / name)
    with pytest.raises(SceneError, match="damaged"):
        Image.load(tmp_path / "x.exr")


@pytest.mark.parametrize("content", [b"", b"P", b"hello, this is a text\n" * 9])
@pytest.mark.parametrize("name", ["x.exr", "x.png"])
def test_a_text_with_the_name_of_a_picture_is_refused(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], name: str, content: bytes
) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(UsageError, match=name) as caught:
        read_recipe(tmp_path / name)
    assert "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")


def recipe_or_refusal(path: Path) -> Recipe | None:
    try:
        return read_recipe(path)
    except UsageError:
        return None


@pytest.mark.parametrize("share", [0.001, 0.2, 0.6, 0.99])
@pytest.mark.parametrize("name", ["x.exr", "x.png"])
def test_half_a_file_is_refused_or_gives_its_whole_recipe(
    tmp_path: Path, name: str, share: float
) -> None:
    image = picture(64, 64)
    image.save(tmp_path / name)
    whole = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(whole[: int(share * len(whole))])
    assert recipe_or_refusal(tmp_path / name) in (image.recipe, None)
    if name == "x.exr":
        with pytest.raises(UsageError, match=r"cannot read|not an EXR"):
            Image.load(tmp_path / name)


@pytest.mark.parametrize("name", ["missing.exr", "missing.png", "folder.exr", "folder.png"])
def test_a_picture_that_cannot_be_opened_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / "folder.exr").mkdir()
    (tmp_path / "folder.png").mkdir()
    with pytest.raises(UsageError, match=rf"{name}: cannot read.*(No such file|Is a directory)"):
        read_recipe(tmp_path / name)


def test_only_exr_holds_radiance_to_load(tmp_path: Path, image: Image) -> None:
    image.save(tmp_path / "x.png")
    with pytest.raises(UsageError, match=r"x\.png: not an EXR image\. Only EXR files hold exact"):
        Image.load(tmp_path / "x.png")
