"""AOVs in files: channels by their names, bit for bit there and back."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import glrt
from glrt.cli.main import main
from glrt.gpu.context import Context
from glrt.image.aovs import CHANNELS, AovImage, from_channels, to_channels
from glrt.image.image import Image, read_recipe
from glrt.settings import Aov
from tests.support.aov_scenes import heap
from tests.support.first_hits import ALL, MEANS, same_aovs
from tests.support.images import same_bits
from tests.support.numerics import Array
from tests.support.renders import rendered, same

SIZE: dict[str, Any] = {"width": 10, "height": 6, "bounces": 1}
COUNTS = ("count", "observations")


@pytest.fixture(scope="module")
def image(context: Context) -> Image:
    """An image with all AOVs: sky, edges, and a part of an observation."""
    return rendered(heap(), context, 37, sampler="sobol", aov=ALL, **SIZE)


def opened(path: Path) -> dict[str, Array]:
    """The channels of a file as other programs see them."""
    import OpenEXR  # type: ignore[import-not-found]

    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {name: channel.pixels for name, channel in file.channels().items()}


# --- files -----------------------------------------------------------------------------------


def test_aovs_come_back_from_a_file_bit_for_bit(image: Image, tmp_path: Path) -> None:
    image.save(tmp_path / "a.exr")
    loaded = Image.load(tmp_path / "a.exr")
    assert [*loaded.aovs] == [*ALL]
    assert same_aovs(loaded.aovs, image.aovs)
    assert same(loaded, image)
    assert (image.aovs["depth"].value == np.inf).any()
    loaded.save(tmp_path / "b.exr")
    assert (tmp_path / "b.exr").read_bytes() == (tmp_path / "a.exr").read_bytes()


def test_channels_have_the_names_that_other_programs_know(image: Image, tmp_path: Path) -> None:
    image.save(tmp_path / "a.exr")
    channels = opened(tmp_path / "a.exr")
    wanted = {
        *("albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z"),
        *("position.X", "position.Y", "position.Z", "object.I"),
    }
    errors = {f"stderr.{name}" for name in wanted if name != "object.I"}
    counts = {f"film.{name}.{what}" for name in MEANS for what in COUNTS}
    plain = {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"}
    assert wanted | errors | counts | plain <= channels.keys()
    others = channels.keys() - wanted - errors - counts - plain
    assert {name.split(".")[1] for name in others} <= {"variance", "part", "begun"}
    aovs = image.aovs
    assert same_bits(channels["albedo.G"], aovs["albedo"].value[..., 1].copy())
    assert same_bits(channels["normal.Z"], aovs["normal"].value[..., 2].copy())
    assert same_bits(channels["depth.Z"], aovs["depth"].value)
    assert same_bits(channels["object.I"], aovs["object"].value)
    assert {
        name: channels[name].dtype for name in ("object.I", "film.depth.count")
    } == dict.fromkeys(("object.I", "film.depth.count"), np.uint32)
    assert all(channels[name].dtype == np.float32 for name in (wanted | errors) - {"object.I"})


@pytest.mark.parametrize(
    ("lost", "rest"),
    [
        ("normal.Y", ("albedo", "depth", "position", "object")),
        ("stderr.depth.Z", ("albedo", "normal", "position", "object")),
        ("film.position.count", ("albedo", "normal", "depth", "object")),
        ("film.albedo.observations", ("normal", "depth", "position", "object")),
        ("object.I", MEANS),
    ],
)
def test_an_aov_that_lost_a_channel_is_left_out(
    image: Image, tmp_path: Path, lost: str, rest: tuple[Aov, ...]
) -> None:
    """A program may keep only channels that it knows; the picture and the other AOVs stay."""
    import OpenEXR

    image.save(tmp_path / "a.exr")
    with OpenEXR.File(str(tmp_path / "a.exr"), separate_channels=True) as file:
        recipe = file.header()["glrt"]
    channels = opened(tmp_path / "a.exr")
    del channels[lost]
    OpenEXR.File({"glrt": recipe}, channels).write(str(tmp_path / "b.exr"))
    loaded = Image.load(tmp_path / "b.exr")
    assert same(loaded, image)
    assert same_aovs(loaded.aovs, {name: image.aovs[name] for name in rest})
    loaded.save(tmp_path / "c.exr")
    assert [*Image.load(tmp_path / "c.exr").aovs] == [*rest]


def test_channels_of_an_aov_that_was_not_asked_for_are_no_aov(image: Image, tmp_path: Path) -> None:
    channels = to_channels(image.aovs)
    assert [*from_channels(channels, ("depth", "object"))] == ["depth", "object"]
    assert dict(from_channels(channels, ())) == {}
    del tmp_path


@pytest.mark.parametrize("name", ALL)
def test_planes_keep_their_places(name: Aov) -> None:
    """A number for each pixel and channel, none twice."""
    names = CHANNELS[name]
    shape = (3, 4) if len(names) == 1 else (3, 4, 3)
    value = np.arange(12 * len(names)).reshape(shape)
    if name == "object":
        aov = AovImage(value.astype(np.uint32))
    else:
        pixels = value.astype(np.float32)
        counts = (np.arange(12, dtype=np.uint32).reshape(3, 4) + 100 * k for k in (1, 2))
        aov = AovImage(pixels, pixels + 50, *counts)
    channels = to_channels({name: aov})
    assert all(plane.shape == (3, 4) for plane in channels.values())
    assert same_aovs(from_channels(channels, (name,)), {name: aov})
    for place, letter in enumerate(names):
        plane = channels[f"{name}.{letter}"]
        assert np.array_equal(plane, value if len(names) == 1 else value[..., place])


# --- Python and the command line -------------------------------------------------------------


def test_a_picture_in_python_has_its_aovs_by_name(context: Context) -> None:
    image = glrt.render(heap(), 32, context, aov=("object", "depth"), **SIZE)
    assert [*image.aovs] == ["depth", "object"]
    depth, number = image.aovs["depth"], image.aovs["object"]
    assert depth.value.shape == number.value.shape == (6, 10)
    assert [depth.value.dtype, number.value.dtype] == [np.dtype("f4"), np.dtype("u4")]
    assert (number.stderr, number.count, number.observations) == (None, None, None)
    assert depth.stderr is not None
    assert depth.count is not None
    assert depth.stderr.shape == depth.count.shape == (6, 10)
    assert image.recipe
    assert image.recipe.settings.aov == ("depth", "object")
    assert glrt.render(heap(), 1, context, **SIZE).aovs == {}


def test_a_picture_keeps_those_of_its_aovs_that_are_wanted(image: Image) -> None:
    some = image.with_aovs(("normal", "object"))
    assert same_aovs(some.aovs, {name: image.aovs[name] for name in ("normal", "object")})
    assert some.recipe
    assert some.recipe.settings.aov == ("normal", "object")
    assert same(some, image)
    assert image.with_aovs(ALL) is image


def test_the_command_writes_what_is_listed_and_renders_it_again(tmp_path: Path) -> None:
    """It reads the recipe in a PNG, which holds no AOV itself."""
    names = [tmp_path / f"a.{suffix}" for suffix in ("exr", "png")]
    words = ["--width", "10", "--height", "6", "--samples", "20", "--aov", "object, depth"]
    outputs = [word for name in names for word in ("-o", str(name))]
    assert main(["render", "cornell", *words, *outputs, "--quiet"]) == 0
    found = Image.load(names[0])
    assert [*found.aovs] == ["depth", "object"]
    assert read_recipe(names[1]).settings.aov == ("depth", "object")
    assert main(["render", str(names[1]), "-o", str(tmp_path / "b.exr"), "--quiet"]) == 0
    assert (tmp_path / "b.exr").read_bytes() == names[0].read_bytes()


def test_a_resumed_picture_may_ask_for_other_aovs(tmp_path: Path) -> None:
    """They cost nothing: they are gathered from the first sample on."""
    small = ["--width", "10", "--height", "6", "--quiet"]
    first, on, whole = (str(tmp_path / f"{name}.exr") for name in ("first", "on", "whole"))
    assert main(["render", "cornell", *small, "--samples", "20", "-o", first]) == 0
    wanted = ["--samples", "40", "--aov", "normal,depth"]
    assert main(["render", "--resume", first, *wanted, "--quiet", "-o", on]) == 0
    assert main(["render", "cornell", *small, *wanted, "-o", whole]) == 0
    assert Path(on).read_bytes() == Path(whole).read_bytes()
