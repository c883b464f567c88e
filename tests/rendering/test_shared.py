"""Pictures by `sampler = shared`: the same bits however samples come, the light of other samplers.

All use one scene, so that they share a kernel.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.comparison.verdict import compare
from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.merge import merge
from glrt.image.shared_numbers import combined
from glrt.rendering.renderer import Renderer
from glrt.samplers import GROUPS
from glrt.settings import Settings
from tests.support.builders import MATTE, lamp, quad, scene_of, sphere
from tests.support.images import same_bits
from tests.support.particle_rooms import room
from tests.support.renders import assert_agree, same

ROOM = scene_of(
    [sphere([0, 0, -3], 1, "matte"), quad([-1, 2, -4], [2, 0, 0], [0, 0, 2], "lamp")],
    {"matte": MATTE, "lamp": lamp(9.0)},
)
SIZE: dict[str, Any] = {"width": 40, "height": 36, "sampler": "shared", "bounces": 3}


def taken(context: Context, samples: int, **settings: Any) -> Image:
    """A picture of so many samples."""
    renderer = Renderer(ROOM, context=context, tier="complete", **{**SIZE, **settings})
    image = renderer.render(samples).image()
    renderer.release()
    return image


@pytest.fixture(scope="module")
def picture(context: Context) -> Image:
    """A picture of two rounds through all groups, and a part of a third."""
    return taken(context, 600)


def test_samples_may_come_in_portions_of_any_size(context: Context, picture: Image) -> None:
    renderer = Renderer(ROOM, context=context, tier="complete", **SIZE)
    for samples in (1, 16, 33, 206, 300, 44):
        renderer.step(samples)
    pieces = renderer.image()
    renderer.release()
    assert (picture.stderr > 0).any()
    assert same(pieces, picture)


@pytest.mark.parametrize("first", [24, 300])
def test_a_picture_that_is_rendered_on_is_that_of_one_render(
    context: Context, picture: Image, tmp_path: Path, first: int
) -> None:
    taken(context, first).save(tmp_path / "first.exr")
    begun = Image.load(tmp_path / "first.exr")
    renderer = Renderer(ROOM, context=context, tier="complete", **SIZE).resume(begun)
    assert same(renderer.image(), begun)
    renderer.render(600).image().save(tmp_path / "on.exr")
    renderer.release()
    picture.save(tmp_path / "whole.exr")
    assert (tmp_path / "on.exr").read_bytes() == (tmp_path / "whole.exr").read_bytes()


def test_parts_are_merged_to_the_picture(context: Context, picture: Image) -> None:
    parts = [taken_part(context, (k, 3)) for k in (1, 2, 3)]
    assert [part.samples for part in parts] == [256, 256, 88]
    found = merge(parts)
    np.testing.assert_allclose(found.radiance, picture.radiance, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(found.stderr, picture.stderr, rtol=1e-3, atol=1e-6)


def taken_part(context: Context, part: tuple[int, int]) -> Image:
    renderer = Renderer(ROOM, context=context, tier="complete", part=part, samples=600, **SIZE)
    image = renderer.render().image()
    renderer.release()
    return image


@pytest.mark.slow
def test_particles_are_a_film_of_their_own(context: Context, tmp_path: Path) -> None:
    """They go on, are merged, and show the light that paths show."""
    scene = room(sphere([0, -0.5, -1], 0.3, "glass"), sphere([0.4, 0.5, -1], 0.1, "dim"))
    ways: dict[str, Any] = {**SIZE, "caustics": "on", "width": 16, "height": 16}

    def rendered(samples: int, **more: Any) -> Image:
        own = {**ways, "samples": 600, **more}
        renderer = Renderer(scene, context=context, tier="complete", **own)
        image = renderer.render(samples).image()
        renderer.release()
        return image

    whole = rendered(600)
    plain = rendered(600, sampler="sobol")
    assert whole.particles is not None
    assert plain.particles is not None
    assert whole.particles.mean.any()
    assert same_bits(whole.particles.mean, plain.particles.mean)
    assert same_bits(whole.particles.variance, plain.particles.variance)
    rendered(300).save(tmp_path / "first.exr")
    renderer = Renderer(scene, context=context, tier="complete", **ways)
    found = renderer.resume(Image.load(tmp_path / "first.exr")).render(600).image()
    renderer.release()
    assert same(found, whole)
    parts = [rendered(n, part=(k, 3)) for k, n in ((1, 256), (2, 256), (3, 88))]
    together = merge(parts)
    np.testing.assert_allclose(together.radiance, whole.radiance, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(together.stderr, whole.stderr, rtol=1e-3, atol=1e-6)
    other = rendered(1024, seed=7, sampler="sobol")
    assert_agree(rendered(1024), other, within=0.07)
    assert compare(whole, other).verdict != "different"


def test_even_groups_have_the_same_numbers_in_all_pixels(picture: Image) -> None:
    """In a tile of the ball, pixels of C err alike: the means of their groups lie apart."""
    assert picture.film_state is not None
    groups = picture.film_state.groups
    assert groups.shape == (GROUPS, 36, 40, 4)
    assert [int(count) for count in groups[:, 0, 0, 3]] == [48] * 5 + [40] + [32] * 10
    tile = groups[:, 14:18, 18:22, :3].mean(axis=-1).reshape(GROUPS, -1).astype(np.float64)
    assert (picture.aovs["object"].value[14:18, 18:22] == 1).all()
    apart = tile - tile.mean(axis=0)
    of_tiles = np.abs(apart.mean(axis=1)) / apart.std(axis=1) * np.sqrt(16)
    assert np.median(of_tiles[0::2]) > 3 * np.median(of_tiles[1::2])


def test_the_picture_has_the_light_of_other_samplers(context: Context) -> None:
    """Whole means, and the means of blocks, by independent seeds."""
    shared, sobol = (
        taken(context, 2048, seed=k, sampler=it) for k, it in ((1, "shared"), (2, "sobol"))
    )
    assert_agree(shared, sobol, within=0.02)
    assert shared.error is not None
    assert sobol.error is not None
    assert shared.error < sobol.error


def test_pictures_are_compared_by_the_samples_that_pixels_do_not_share(
    context: Context, picture: Image
) -> None:
    other = taken(context, 600, seed=9, sampler="sobol")
    assert compare(picture, other).verdict != "different"
    brighter = Image(other.radiance * np.float32(1.5), other.stderr, other.samples, other.recipe)
    assert compare(picture, brighter).verdict == "different"
    lost = Image(picture.radiance, picture.stderr, picture.samples, picture.recipe)
    with pytest.raises(UsageError, match="--sampler shared err alike"):
        compare(lost, other)


def test_below_a_whole_block_the_error_is_unknown(context: Context) -> None:
    image = taken(context, 240)
    assert image.error is None
    assert image.film_state is not None
    counts = image.film_state.groups[..., 3:].astype(np.float64)
    mean = (image.film_state.groups[..., :3] * counts).sum(axis=0) / 240
    np.testing.assert_allclose(image.radiance, mean, rtol=1e-5, atol=1e-6)


def test_the_picture_follows_from_its_file(picture: Image) -> None:
    assert picture.film_state is not None
    again = combined(picture.film_state.groups, picture.aovs["object"].value)
    assert same_bits(again.radiance, picture.radiance)


def test_observations_are_pairs_of_groups() -> None:
    shared = Settings(sampler="shared").division
    assert [shared.observations(samples) for samples in (0, 31, 64, 256, 4096)] == [0, 0, 2, 8, 8]
    assert shared.block == shared.least_known == 256
