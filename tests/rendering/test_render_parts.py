"""Parts rendered and merged: the light of one render, with the error that it has, to the bit."""

import contextlib
import math
import random
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.merge import merge
from glrt.image.partition import Partition
from glrt.rendering.render_parts import render_parts
from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Interruption
from glrt.scene.scene import Scene
from tests.support.alarms import assert_near
from tests.support.aov_scenes import heap
from tests.support.builders import MATTE, lamp, plane, scene_of, sphere
from tests.support.first_hits import ALL, same_aovs
from tests.support.images import same_bits
from tests.support.numerics import Array
from tests.support.renders import SAMPLERS, assert_agree, rendered, rendering, same

SMALL: dict[str, Any] = {"width": 8, "height": 8, "bounces": 2}


def floor_under_a_lamp() -> Scene:
    objects = [plane([0, -1, 0], [0, 1, 0], "floor"), sphere([0, 1, -3], 0.5, "lamp")]
    materials = {"floor": MATTE, "lamp": lamp(4.0)}
    return scene_of(objects, materials, {"look_at": [0, -1, -2], "fov": 40})


def parts_of(
    scene: Scene, context: Context, count: int, numbers: Sequence[int] = (), **settings: Any
) -> list[Image]:
    """Parts of a render by their numbers, or all."""
    options = {**SMALL, **settings}
    renderer = Renderer(scene, context=context, part=(1, count), **options)
    images = []
    for number in numbers or range(1, count + 1):
        renderer.begin_part(number)
        images.append(renderer.render().image())
    renderer.release()
    return images


# --- the same light ------------------------------------------------------------------------------


@pytest.mark.slow_cases("independent")
@pytest.mark.parametrize("sampler", SAMPLERS)
def test_merged_parts_are_one_render_up_to_rounding(context: Context, sampler: str) -> None:
    """The samples and the observations of the parts are those of the render."""
    options: dict[str, Any] = {"samples": 149, "sampler": sampler, "aov": (*ALL, "bounces")}
    found = merge(parts_of(heap(), context, 4, **options))
    with rendering(heap(), context, **{**SMALL, **options}) as renderer:
        whole = renderer.render().image()
    np.testing.assert_allclose(found.radiance, whole.radiance, rtol=2e-6)
    np.testing.assert_allclose(found.stderr, whole.stderr, rtol=1e-3)
    assert found.error == pytest.approx(whole.error, rel=1e-4)
    assert not same_bits(found.radiance, whole.radiance), "added in another order"
    assert [*found.aovs] == [*whole.aovs]
    for name, aov in whole.aovs.items():
        merged = found.aovs[name]
        np.testing.assert_allclose(merged.value, aov.value, rtol=1e-5, atol=1e-6)
        if name == "object":
            assert same_bits(merged.value, aov.value)
            continue
        assert merged.count is not None
        assert aov.count is not None
        assert same_bits(merged.count, aov.count)
        assert np.array_equal(merged.observations, aov.observations)  # type: ignore[arg-type]


@pytest.mark.parametrize("numbers", [(1, 2, 3, 4, 5, 6, 7, 8), (2, 3, 7), (8,), (1, 8)])
def test_mean_and_error_are_those_of_the_observations_that_are_there(
    context: Context, numbers: tuple[int, ...]
) -> None:
    """Each part is one observation: plain float64 sums over them are the truth."""
    images = parts_of(heap(), context, 8, numbers, samples=128, aov=("depth",))
    found = merge(images, incomplete=len(numbers) < 8)
    means = np.array([image.radiance for image in images], np.float64)
    np.testing.assert_allclose(found.radiance, means.mean(axis=0), rtol=2e-7)
    if len(numbers) < 2:
        assert np.isnan(found.stderr).all()
        return
    error = means.std(axis=0, ddof=1) / math.sqrt(len(numbers))
    np.testing.assert_allclose(found.stderr, error, rtol=1e-4, atol=1e-7)
    depths = np.array([image.aovs["depth"].value for image in images], np.float64)
    depth = found.aovs["depth"]
    assert depth.count is not None
    assert depth.stderr is not None
    is_full = depth.count == 16 * len(numbers)
    assert is_full.sum() > 20
    spread = depths[:, is_full].std(axis=0, ddof=1) / math.sqrt(len(numbers))
    np.testing.assert_allclose(depth.value[is_full], depths[:, is_full].mean(axis=0), rtol=2e-7)
    np.testing.assert_allclose(depth.stderr[is_full], spread, rtol=1e-3, atol=1e-7)


def test_a_part_begins_where_the_one_before_it_ended(context: Context) -> None:
    """No sample is in two parts, and none in no part: of one sample each, all differ."""
    images = parts_of(floor_under_a_lamp(), context, 4, samples=4, sampler="independent")
    alone = rendered(floor_under_a_lamp(), context, 1, **SMALL)
    assert same_bits(images[0].radiance, alone.radiance)
    for number, image in enumerate(images):
        assert image.samples == 1
        assert not any(same_bits(image.radiance, other.radiance) for other in images[:number])


def test_merged_parts_agree_with_a_render_of_another_seed(context: Context) -> None:
    options: dict[str, Any] = {"width": 16, "height": 16, "sampler": "sobol"}
    parts = parts_of(floor_under_a_lamp(), context, 3, samples=300, **options)
    plain = rendered(floor_under_a_lamp(), context, 304, **SMALL | options, seed=9)
    assert_agree(merge(parts), plain, within=0.02)


def merged_means(context: Context, renders: int, samples: int, count: int) -> tuple[Array, Array]:
    """Values and standard errors of merged pictures of new seeds, (renders, H, W, C) each."""
    values, errors = [], []
    options: dict[str, Any] = {**SMALL, "sampler": "sobol", "samples": samples}
    renderer = Renderer(floor_under_a_lamp(), context=context, part=(1, count), **options)
    for seed in range(renders):
        renderer.update(seed=100 + seed)
        images = []
        for number in range(1, count + 1):
            renderer.begin_part(number)
            images.append(renderer.render().image())
        found = merge(images)
        values.append(found.radiance)
        errors.append(found.stderr)
    renderer.release()
    return np.array(values, np.float64), np.array(errors, np.float64)


@pytest.mark.parametrize(("samples", "count"), [(96, 3), (90, 2)])
def test_errors_of_merged_pictures_are_what_seeds_show(
    context: Context, samples: int, count: int
) -> None:
    """RMS of the deviations from a long render over that of the errors, pixel by pixel.

    64 renders of 64 pixels, whose channels are alike: chi-square of 4096 degrees is known to
    sqrt(2 / 4096), and the estimates add a fifth of that, of six observations each; the root to
    half of it. 5.3 such deviations are 6.5 %.
    """
    renders = 64
    truth = rendered(floor_under_a_lamp(), context, 1 << 14, **SMALL, sampler="sobol", seed=1)
    values, errors = merged_means(context, renders, samples, count)
    squares = np.square(values - truth.radiance).mean(axis=0) - np.square(truth.stderr)
    ratio = float(np.sqrt((squares / np.square(errors).mean(axis=0)).mean()))
    assert_near(ratio, 1, 0.5 * math.sqrt(2 * 1.2 / (renders * 64)))


# --- the same bits -------------------------------------------------------------------------------


def rendered_again(image: Image, context: Context, **more: Any) -> Image | None:
    """The picture rendered again from its recipe alone."""
    recipe = image.recipe
    assert recipe
    assert recipe.partition
    first = recipe.partition.numbers[0], recipe.partition.count
    renderer = Renderer(recipe.scene, recipe.settings, context, part=first)
    found = render_parts(renderer, recipe.partition, Interruption(), **more)
    renderer.release()
    return found


@pytest.mark.parametrize("numbers", [(1, 2, 3, 4, 5, 6, 7), (2, 3, 5), (7,), (1, 7)])
def test_a_merged_picture_is_rendered_again_to_the_same_bits(
    context: Context, numbers: tuple[int, ...]
) -> None:
    images = parts_of(heap(), context, 7, numbers, samples=149, aov=ALL)
    random.Random(5).shuffle(images)
    found = merge(images, incomplete=len(numbers) < 7)
    again = rendered_again(found, context)
    assert again
    assert same(again, found)
    assert same_aovs(again.aovs, found.aovs)
    assert again.recipe == found.recipe


def test_a_part_that_is_merged_alone_is_the_part(context: Context) -> None:
    """Since its recipe is that of the part, so must be its bits."""
    size = {"width": 16, "height": 16}
    (part,) = parts_of(heap(), context, 2, (1,), samples=192, aov=ALL, **size)
    found = merge([part], incomplete=True)
    assert found.recipe == part.recipe
    assert same(found, part)
    assert same_aovs(found.aovs, part.aovs)


def test_an_interruption_leaves_the_parts_that_are_whole(context: Context) -> None:
    images = parts_of(heap(), context, 4, samples=64)
    whole, interruption = merge(images), Interruption()

    def watch(renderer: Renderer) -> None:
        if renderer.plan.first_sample == 32:
            interruption.signal = 2

    assert whole.recipe
    first = Renderer(heap(), whole.recipe.settings, context, part=(1, 4))
    partition = Partition(count=4, numbers=(1, 2, 3, 4))
    found = render_parts(first, partition, interruption, watch)
    assert found
    assert found.samples in (32, 48), "the third part, of one dispatch, may be whole"
    held = found.samples // 16
    assert same(found, merge(images[:held], incomplete=True))
    interruption.signal = 2
    assert render_parts(first, partition, interruption) is None
    first.release()


def test_a_part_has_the_same_bits_however_it_is_dispatched(context: Context) -> None:
    (expected,) = parts_of(heap(), context, 3, (2,), samples=149, aov=ALL)
    renderer = Renderer(heap(), context=context, part=(2, 3), samples=149, aov=ALL, **SMALL)
    assert renderer.wanted_samples == expected.samples == 48
    while renderer.samples < renderer.wanted_samples:
        renderer.step(7 if renderer.samples < 42 else 6)
        renderer.image()
    assert same(renderer.image(), expected)
    assert same_aovs(renderer.image().aovs, expected.aovs)
    renderer.restart()
    assert same(renderer.render().image(), expected), "a restart begins with the part again"
    renderer.release()


# --- edits of a part -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    "change",
    [{"seed": 3}, {"bounces": 1}, {"samples": 192}, {"sampler": "independent"}],
    ids=lambda change: next(iter(change)),
)
def test_an_edited_part_is_the_part_of_the_edited_render(
    context: Context, change: dict[str, Any]
) -> None:
    """Which samples it has follows from their number in all and from the sampler, too."""
    options: dict[str, Any] = {"samples": 100, "aov": ("depth",)}
    (expected,) = parts_of(heap(), context, 3, (2,), **{**options, **change})
    renderer = Renderer(heap(), context=context, part=(2, 3), **{**SMALL, **options})
    renderer.render()
    renderer.update(**change)
    found = renderer.render().image()
    renderer.release()
    assert found.recipe == expected.recipe
    assert same(found, expected)
    assert same_aovs(found.aovs, expected.aovs)


def test_too_few_samples_for_the_parts_are_refused(context: Context) -> None:
    renderer = Renderer(heap(), context=context, part=(2, 3), **SMALL, samples=96)
    before = renderer.render().image()
    with pytest.raises(UsageError, match="32 samples make at most 2 parts"):
        renderer.update(samples=32)
    assert same(renderer.image(), before)
    renderer.release()


def test_a_part_does_not_take_samples_of_the_next(context: Context) -> None:
    """It ends there, or says so."""
    renderer = Renderer(heap(), context=context, part=(2, 3), **SMALL, samples=96)
    with contextlib.suppress(UsageError):
        renderer.render(40)
    assert renderer.samples <= 32
    renderer.release()
