"""Parts merged: the picture of all their samples, in whatever order they come."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import permutations
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.image.film_state import FilmState
from glrt.image.image import Image
from glrt.image.merge import merge, merged_image
from glrt.image.partition import Partition
from glrt.image.recipe import Recipe
from glrt.settings import Aov
from tests.support.first_hits import same_aovs
from tests.support.raw_samples import BLOCK, Render, aov_of, picture_of, render_of
from tests.support.renders import same

ALL: tuple[Aov, ...] = ("albedo", "normal", "depth", "position", "object")
RENDER = render_of(9 * BLOCK + 5, "normal", "depth")


def recipe_of(image: Image) -> Recipe:
    assert image.recipe
    return image.recipe


def state_of(image: Image) -> FilmState:
    assert image.film_state
    return image.film_state


def parts(count: int, numbers: Sequence[int] = (), of: Render = RENDER) -> list[Image]:
    """Parts of a render by their numbers, or all."""
    return [of.part(number, count) for number in numbers or range(1, count + 1)]


def assert_near(found: Image, truth: Image) -> None:
    """Values agree to the rounding of the parts' means to float32, and counts exactly."""
    pairs: list[tuple[Any, Any]] = [(found.radiance, truth.radiance), (found.stderr, truth.stderr)]
    pairs += [*zip(state_of(found), state_of(truth), strict=True)]
    assert [*found.aovs] == [*truth.aovs]
    for name, aov in truth.aovs.items():
        for field in ("value", "stderr", "count", "observations"):
            pairs.append((getattr(found.aovs[name], field), getattr(aov, field)))
    for a, b in pairs:
        if a is None or b is None:
            assert a is b
            continue
        assert (a.dtype, a.shape) == (b.dtype, b.shape)
        is_count = np.array_equal(b, np.rint(b))
        np.testing.assert_allclose(a, b, rtol=0 if is_count else 1e-4)
    np.testing.assert_allclose(found.radiance, truth.radiance, rtol=5e-7)


# --- the picture of all samples ----------------------------------------------------------------


CUTS = [(160, 1), (160, 2), (160, 3), (160, 10), (149, 2), (149, 7), (149, 10), (17, 2)]


@pytest.mark.parametrize(("samples", "count"), [*CUTS, (16, 1), (33, 3)])
def test_parts_together_hold_what_one_film_holds(samples: int, count: int) -> None:
    """The last may end inside an observation: of 17 samples the second part has one."""
    render = render_of(samples, *ALL)
    whole = render.part(1, 1)
    found = merge(parts(count, of=render))
    assert_near(found, whole)
    assert found.samples == recipe_of(found).samples == samples
    numbers = tuple(range(1, count + 1))
    assert recipe_of(found).partition == Partition(count=count, numbers=numbers)
    assert recipe_of(found).settings == recipe_of(whole).settings
    assert recipe_of(found).scene == recipe_of(whole).scene


def test_dropped_samples_and_empty_pixels_stay_what_they_are() -> None:
    """A pixel that meets nothing, one that does in the first part alone, and edges."""
    depth = render_of(160, "depth").aovs["depth"]
    is_empty = np.random.default_rng(4).random((10, *depth.shape[1:3])) < 0.3
    depth[np.repeat(is_empty, BLOCK, axis=0)] = np.nan
    depth[:, 0, 0] = depth[64:, 0, 1] = np.nan
    samples = render_of(160).samples
    samples[:, 1, 1] = samples[32:48, 2, 2] = np.nan
    render = Render(samples, {"depth": depth})
    found, whole = merge(parts(3, of=render)), render.part(1, 1)
    assert_near(found, whole)
    assert found.aovs["depth"].value[0, 0] == np.inf
    assert np.isfinite(found.aovs["depth"].value[0, 1])
    assert state_of(found).dropped[1, 1] == 160
    assert state_of(found).observations[1, 1] == 0
    assert np.isnan(found.stderr[1, 1]).all()
    assert (state_of(found).dropped[2, 2], state_of(found).observations[2, 2]) == (16, 9)


def test_fewer_than_two_observations_have_no_error() -> None:
    render = render_of(20, "depth")
    found = merge(parts(2, of=render))
    assert np.isnan(found.stderr).all()
    error = found.aovs["depth"].stderr
    assert error is not None
    assert np.isfinite(error).all(), "whose second observation is whole"


@pytest.mark.parametrize("count", [2, 5])
def test_bits_do_not_depend_on_the_order(count: int, tmp_path: Path) -> None:
    """The file does not either: where parts may differ, as in exposure, it has part 1's value."""
    given = [
        replace(image, recipe=recipe_of(image).model_copy(update={"settings": settings}))
        for number, image in enumerate(parts(count))
        for settings in [recipe_of(image).settings.model_copy(update={"exposure": number / 2})]
    ]
    merge(given).save(tmp_path / "first.exr")
    expected = (tmp_path / "first.exr").read_bytes()
    orders = [*permutations(given)][1 :: 11 if count > 2 else 1]
    for order in orders:
        merge(order).save(tmp_path / "other.exr")
        assert (tmp_path / "other.exr").read_bytes() == expected
    assert recipe_of(Image.load(tmp_path / "first.exr")).settings.exposure == 0


@pytest.mark.parametrize("numbers", [(1, 2), (3, 4), (2, 4), (1, 3, 4), (4,), (2,)])
def test_an_incomplete_picture_has_the_error_of_the_samples_that_are_there(
    numbers: tuple[int, ...],
) -> None:
    """Nine observations and five samples are in four parts of two, two, three and three."""
    ranges = {1: slice(0, 32), 2: slice(32, 80), 3: slice(80, 112), 4: slice(112, 149)}
    found = merge(parts(4, numbers), incomplete=True)
    held = np.concatenate([RENDER.samples[ranges[n]] for n in numbers])
    whole = {n: slice(r.start, -(-r.stop // BLOCK) * BLOCK) for n, r in ranges.items()}
    aovs = {
        name: aov_of(name, np.concatenate([raw[whole[n]] for n in numbers]))
        for name, raw in RENDER.aovs.items()
    }
    assert found.samples == len(held)
    assert_near(found, picture_of(held, recipe_of(found), aovs))
    assert str(recipe_of(found).partition) == f"{', '.join(map(str, numbers))} of 4"


def test_a_merged_file_holds_what_was_merged(tmp_path: Path) -> None:
    found = merge(parts(3, (1, 3)), incomplete=True)
    found.save(tmp_path / "merged.exr")
    loaded = Image.load(tmp_path / "merged.exr")
    assert same(loaded, found)
    assert same_aovs(loaded.aovs, found.aovs)
    assert loaded.recipe == found.recipe
    for a, b in zip(state_of(loaded), state_of(found), strict=True):
        assert np.array_equal(a, b)


def test_parts_from_files_are_those_from_memory(tmp_path: Path) -> None:
    """Each part is loaded when its turn comes, in the order of the parts, once for each film."""
    render = render_of(149, *ALL)
    given, loaded = {f"{n}.exr": image for n, image in enumerate(parts(4, of=render))}, []
    for name, image in given.items():
        image.save(tmp_path / name)

    def load(name: str) -> Image:
        loaded.append(name)
        return Image.load(tmp_path / name)

    recipes = {name: image.recipe for name, image in reversed(given.items())}
    found = merged_image(recipes, load)
    assert same(found, merge(list(given.values())))
    assert same_aovs(found.aovs, merge(list(given.values())).aovs)
    assert loaded[:4] == [*given]
    assert len(loaded) <= 4 * (1 + len(ALL))


def test_parts_by_several_drivers_are_named_together() -> None:
    """Their names are in alphabetical order, whichever came first."""
    first, second, third = parts(3)
    drivers = {"renderer": "zink", "pipeline": "fragment"}
    other = replace(first, recipe=recipe_of(first).model_copy(update=drivers))
    for given in ([other, second, third], [third, other, second]):
        recipe = recipe_of(merge(given))
        assert recipe.renderer == "llvmpipe and zink"
        assert recipe.pipeline == "compute and fragment"
        assert recipe.tier == "generic"


def test_channels_are_merged_on_their_own() -> None:
    """Green alone is brighter in the second part."""
    plain = render_of(64)
    samples = plain.samples.copy()
    samples[32:, ..., 1] += 1
    a, b = (merge(parts(2, of=Render(s, {}))).radiance for s in (plain.samples, samples))
    assert np.array_equal(a[..., ::2], b[..., ::2])
    np.testing.assert_allclose(b[..., 1] - a[..., 1], 0.5, rtol=1e-4)
