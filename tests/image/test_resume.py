"""A render goes on from its picture: to the bits of one without a pause, or it is refused."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.film_state import FilmState, from_channels, to_channels
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.image.resume import fitting
from glrt.phong import Phong
from glrt.rendering.renderer import Renderer
from glrt.settings import Settings
from tests.support.builders import MATTE, lamp, quad, scene_of, sphere
from tests.support.images import picture, same_bits

ROOM = scene_of(
    [sphere([0, 0, -3], 1, "matte"), quad([-1, 2, -4], [2, 0, 0], [0, 0, 2], "lamp")],
    {"matte": MATTE, "lamp": lamp(9.0)},
)
SIZE = {"width": 24, "height": 16}


def taken(context: Context, samples: int, **settings: Any) -> Renderer:
    """A renderer with so many samples."""
    options = {"context": context, "tier": "complete", **SIZE, **settings}
    return Renderer(ROOM, samples=64, **options).render(samples)


# --- the same bits -------------------------------------------------------------------------


@pytest.mark.parametrize("pipeline", ["compute", "fragment"])
@pytest.mark.parametrize(
    ("sampler", "first"), [("independent", 1), ("independent", 7), ("sobol", 16), ("sobol", 21)]
)
def test_a_picture_that_is_rendered_on_is_the_file_of_one_render(
    context: Context, tmp_path: Path, sampler: str, first: int, pipeline: str
) -> None:
    """Byte by byte: within a block of Sobol's points, too."""
    settings = {"sampler": sampler, "pipeline": pipeline}
    taken(context, first, **settings).image().save(tmp_path / "first.exr")
    on = taken(context, 0, **settings).resume(Image.load(tmp_path / "first.exr"))
    assert on.samples == first
    on.render(39).image().save(tmp_path / "on.exr")
    whole = taken(context, 39, **settings).image()
    assert whole.radiance.any()
    whole.save(tmp_path / "whole.exr")
    assert (tmp_path / "on.exr").read_bytes() == (tmp_path / "whole.exr").read_bytes()


@pytest.mark.parametrize("tier", ["generic", "storage"])
def test_other_tiers_and_crops_go_on_alike(context: Context, tmp_path: Path, tier: str) -> None:
    settings: dict[str, Any] = {"tier": tier, "crop": (3, 2, 11, 9), "seed": 5}
    taken(context, 20, **settings).image().save(tmp_path / "first.exr")
    on = taken(context, 0, **settings).resume(Image.load(tmp_path / "first.exr")).render(40)
    whole = taken(context, 40, **settings)
    assert same_bits(on.image().radiance, whole.image().radiance)
    assert same_bits(on.image().stderr, whole.image().stderr)


def test_a_picture_goes_on_many_times(context: Context) -> None:
    image = taken(context, 1).image()
    for samples in (2, 15, 16, 17, 40):
        image = taken(context, 0).resume(image).render(samples).image()
    whole = taken(context, 40).image()
    assert same_bits(image.radiance, whole.radiance)
    assert same_bits(image.stderr, whole.stderr)


def test_a_picture_goes_on_in_place_of_what_was_there(context: Context) -> None:
    first = taken(context, 5).image()
    other = taken(context, 9).resume(first)
    assert other.samples == 5
    assert same_bits(other.image().radiance, first.radiance)


@pytest.mark.parametrize("samples", [1, 16, 21, 40])
def test_any_film_comes_back_from_its_channels(samples: int) -> None:
    """Some samples are dropped, some blocks wholly, and errors have every size."""
    random = np.random.default_rng(3)
    size, block = (9, 8), 16
    dropped = random.integers(0, min(samples, 3), size).astype(np.float32)
    observations = samples // block - (random.random(size) < 0.3) * min(samples // block, 1)
    variance = np.power(10, random.uniform(-44, 38, (*size, 3))).astype(np.float32)
    variance[0] = [0, 1e-45, 3.4e38]
    begun = random.integers(0, 16, size).astype(np.float32) * (samples % block > 0)
    part = variance[::-1] * (samples % block > 0)
    film = FilmState(variance, dropped, observations.astype(np.float32), part, begun)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        stderr = np.sqrt(variance / (film.observations[..., None] - 1)).astype(np.float32)
    back = from_channels(planes(to_channels(film, stderr, samples, block)), stderr, samples, block)
    assert back is not None
    for name in FilmState._fields:
        assert same_bits(getattr(back, name), getattr(film, name)), name


def planes(channels: dict[str, Any]) -> dict[str, Any]:
    """Channels as a file holds them, (H, W) each."""
    found = {}
    for name, pixels in channels.items():
        if pixels.ndim == 2:
            found[name] = pixels
        else:
            found |= {f"{name}.{c}": pixels[..., i] for i, c in enumerate("RGB")}
    return found


def test_what_a_picture_keeps_for_it_takes_a_tenth_of_the_file(
    context: Context, tmp_path: Path
) -> None:
    """Between observations; within one, the variance itself is kept."""
    image = taken(context, 32, width=64, height=64).image()
    image.save(tmp_path / "a.exr")
    replace(image, film_state=None).save(tmp_path / "b.exr")
    sizes = [(tmp_path / name).stat().st_size for name in ("a.exr", "b.exr")]
    assert sizes[1] < sizes[0] < 1.1 * sizes[1]


# --- refusals ------------------------------------------------------------------------------


@pytest.fixture
def begun(context: Context) -> Image:
    return taken(context, 21).image()


def recipe_of(image: Image, **changes: Any) -> Recipe:
    assert image.recipe
    settings = {name: changes.pop(name) for name in list(changes) if name in Settings.model_fields}
    wanted = image.recipe.settings.model_copy(update=settings)
    return image.recipe.model_copy(update={"settings": wanted, **changes})


@pytest.mark.parametrize(
    ("name", "value"),
    [("samples", 1000), ("exposure", 2.0), ("tonemap", "aces"), ("denoise", "nlm")],
)
def test_what_changes_no_sample_may_change(begun: Image, name: str, value: Any) -> None:
    assert fitting(begun, recipe_of(begun, **{name: value})) is begun.film_state


def test_title_and_wished_samples_of_a_scene_may_change(begun: Image) -> None:
    wishes = ROOM.render.model_copy(update={"samples": 7})
    scene = ROOM.model_copy(update={"title": "another", "render": wishes})
    assert fitting(begun, recipe_of(begun, scene=scene)) is begun.film_state


@pytest.mark.parametrize(
    ("name", "value"),
    [
        *(("width", 25), ("height", 17), ("bounces", 3), ("method", "nee"), ("seed", 1)),
        *(("crop", (0, 0, 5, 5)), ("sampler", "independent"), ("roulette", False)),
        *(("caustics", "on"), ("particles", 1.0), ("aimed", 0.1), ("linked", 0.5), ("probes", 4)),
        *(("reuse", "both"), ("unbiased", False), ("phong", Phong(ambient=0.1))),
        *(("effects", ("shadows",)), ("march_step", 0.5), ("adaptive", "on")),
        *(("version", "9.9"), ("renderer", "another"), ("tier", "generic")),
        ("pipeline", "fragment"),
    ],
)
def test_what_changes_samples_is_refused_by_its_name(begun: Image, name: str, value: Any) -> None:
    with pytest.raises(UsageError, match=f"{name} is .* in the picture and .* now"):
        fitting(begun, recipe_of(begun, **{name: value}))


def test_every_setting_is_free_or_refused(begun: Image) -> None:
    """A new setting must come into one of the two lists above."""
    free = {"samples", "exposure", "tonemap", "aov", "denoise"}
    known = {"width", "height", "bounces", "method", "seed", "crop", "sampler", "roulette"}
    known |= {"caustics", "particles", "aimed", "linked", "probes", "reuse", "unbiased"}
    known |= {"phong", "effects", "march_step", "adaptive"}
    assert set(Settings.model_fields) == free | known


def test_another_scene_is_refused_by_what_differs(begun: Image) -> None:
    ball = ROOM.objects[0].model_copy(update={"radius": 1.5})
    for update, said in (
        ({"objects": (ball, *ROOM.objects[1:])}, r"objects\[0\]\.radius is 1\.0 .* and 1\.5 now"),
        ({"objects": ROOM.objects[1:]}, "number of objects is 2 in the picture and 1 now"),
        ({"lights": {"lamp": 2.0}}, r"lights\.lamp is not given .* and 2\.0 now"),
    ):
        with pytest.raises(UsageError, match=said):
            fitting(begun, recipe_of(begun, scene=ROOM.model_copy(update=update)))


@pytest.mark.parametrize(
    ("image", "said"),
    [
        (picture(), "no film state"),
        (replace(picture(), recipe=None), "no recipe"),
    ],
)
def test_pictures_of_others_are_refused(image: Image, said: str) -> None:
    with pytest.raises(UsageError, match=said):
        fitting(image, picture().recipe)  # type: ignore[arg-type]


def test_a_picture_that_lost_a_channel_is_refused(begun: Image, tmp_path: Path) -> None:
    """A program may not know unsigned channels, or not the channels of glrt."""
    import OpenEXR  # type: ignore[import-not-found]

    begun.save(tmp_path / "a.exr")
    with OpenEXR.File(str(tmp_path / "a.exr"), separate_channels=True) as file:
        recipe = file.header()["glrt"]
        channels = {name: channel.pixels for name, channel in file.channels().items()}
    assert Image.load(tmp_path / "a.exr").film_state
    for lost in ("film.variance.G", "film.part.B", "film.begun"):
        rest = {name: pixels for name, pixels in channels.items() if name != lost}
        OpenEXR.File({"glrt": recipe}, rest).write(str(tmp_path / "b.exr"))
        assert Image.load(tmp_path / "b.exr").film_state is None


def test_a_relit_picture_is_refused(context: Context) -> None:
    renderer = Renderer(ROOM, None, context, layering="groups", width=24, height=16).render(2)
    renderer.update(ROOM.model_copy(update={"lights": {"lamp": 0.5}}))
    with pytest.raises(UsageError, match="its light was changed"):
        fitting(renderer.image(), renderer.image().recipe)  # type: ignore[arg-type]
