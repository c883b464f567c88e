"""Pictures with particles in files: two films, gone on from and put together."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.core.errors import UsageError
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.image.merge import merge
from glrt.image.particle_film import ParticleFilm, summed
from glrt.image.partition import Partition
from glrt.rendering.render_parts import render_parts
from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Interruption
from tests.support.images import same_bits
from tests.support.particle_rooms import ROOMS
from tests.support.renders import rendered, same

SCENE = ROOMS["a lens"]
OPTIONS: dict[str, Any] = {"caustics": "on", "linked": 0.0, "bounces": 4, "sampler": "sobol"}
SIZE: dict[str, Any] = {"width": 16, "height": 12, **OPTIONS}


def renderer(context: Context, **more: Any) -> Renderer:
    return Renderer(SCENE, None, context, "complete", **{"samples": 72, **SIZE}, **more)


def parts_of(context: Context) -> list[Image]:
    images = []
    for number in (1, 2, 3):
        one = renderer(context, part=(number, 3))
        images.append(one.render().image())
        one.release()
    return images


def test_the_picture_is_the_sum_of_its_films(context: Context) -> None:
    image = rendered(SCENE, context, 40, **OPTIONS)
    films = image.particles
    assert films
    assert same_bits(image.radiance, films.camera + films.mean)
    assert (films.camera > 0).any()
    assert (films.mean > 0).any()


def test_their_variances_add() -> None:
    """5 observations of variance 4 and a camera film whose error is 2: sqrt(4 + 4 / 4)."""
    ones = np.ones((2, 3, 3), np.float32)
    radiance, stderr = summed(ParticleFilm(ones, 2 * ones, 4 * ones), 2 * ones, 5)
    np.testing.assert_allclose(radiance, 3)
    np.testing.assert_allclose(stderr, np.sqrt(5), rtol=1e-6)


def test_a_file_holds_both_films(context: Context, tmp_path: Path) -> None:
    image = rendered(SCENE, context, 40, **OPTIONS)
    image.save(tmp_path / "a.exr")
    again = Image.load(tmp_path / "a.exr")
    assert image.particles
    assert again.particles
    assert same(image, again)
    for one, other in zip(image.particles, again.particles, strict=True):
        assert same_bits(one, other)
    assert rendered(SCENE, context, 1, bounces=1).particles is None


@pytest.mark.slow_cases("71")
@pytest.mark.parametrize("begun", [16, 24, 71])
def test_a_render_goes_on_to_the_same_bits(context: Context, tmp_path: Path, begun: int) -> None:
    """It goes on at the end of an observation, or within one that has its particles already."""
    first, second, plain = renderer(context), renderer(context), renderer(context)
    first.render(begun).image().save(tmp_path / "a.exr")
    second.resume(Image.load(tmp_path / "a.exr"))
    found, expected = second.render().image(), plain.render().image()
    assert same(found, expected)
    assert found.particles
    assert expected.particles
    assert same_bits(found.particles.variance, expected.particles.variance)
    for one in (first, second, plain):
        one.release()


def test_without_its_films_a_picture_is_not_gone_on_from(context: Context) -> None:
    image = replace(rendered(SCENE, context, 32, **OPTIONS), particles=None)
    again = Renderer(SCENE, None, context, width=16, height=16, samples=32, **OPTIONS)
    with pytest.raises(UsageError, match="no film state"):
        again.resume(image)
    again.release()


def test_parts_make_the_picture_and_its_error(context: Context) -> None:
    whole = renderer(context)
    expected = whole.render().image()
    whole.release()
    found = merge(parts_of(context))
    np.testing.assert_allclose(found.radiance, expected.radiance, rtol=1e-5, atol=1e-6)
    np.testing.assert_allclose(found.stderr, expected.stderr, rtol=1e-3, atol=1e-6)
    assert found.particles
    assert same_bits(found.radiance, found.particles.camera + found.particles.mean)


def test_parts_without_their_films_are_not_merged(context: Context) -> None:
    images = parts_of(context)
    with pytest.raises(UsageError, match="lacks the state of its film"):
        merge([images[0], replace(images[1], particles=None), images[2]])


def test_a_merged_picture_is_rendered_again_to_the_same_bits(context: Context) -> None:
    expected = merge(parts_of(context))
    one = renderer(context, part=(1, 3))
    found = render_parts(one, Partition(count=3, numbers=(1, 2, 3)), Interruption())
    one.release()
    assert found
    assert same(found, expected)
