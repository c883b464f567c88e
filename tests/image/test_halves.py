"""The two halves of a picture are what two renders of their samples are."""

from typing import Any

import numpy as np
import pytest

from glrt import Image, Renderer
from glrt.denoise.half import Half
from glrt.gpu.context import Context
from glrt.image.halves import halves_of
from glrt.image.moments import combined, without
from glrt.scene.scene import Scene
from tests.image.test_moments import assert_same, cut
from tests.support.particle_rooms import ROOMS
from tests.support.raw_samples import BLOCK, moments_of, noise

OPTIONS: dict[str, Any] = {"width": 16, "height": 12, "bounces": 4, "aov": ("albedo", "normal")}
SCENE = ROOMS["a lens"]


@pytest.mark.parametrize("place", [1, 3, 8])
@pytest.mark.parametrize("rest", [0, 1, 15])
def test_what_was_put_together_comes_apart(place: int, rest: int) -> None:
    first, second = map(moments_of, cut(noise(10 * BLOCK + rest), [place]))
    assert_same(without(combined(first, second), first), second, 1e-9)


def test_nothing_but_rounding_makes_no_variance() -> None:
    """Where all samples are equal, the difference of two variances is rounding alone."""
    first, second = map(moments_of, cut(np.full_like(noise(4 * BLOCK), 0.1), [2]))
    whole = combined(first, second)
    first = first._replace(variance=first.variance + 1e-18)
    assert (without(whole, first).variance >= 0).all()


def part(context: Context, scene: Scene, number: int, samples: int, **more: Any) -> Image:
    """The k-th half of so many samples, rendered alone."""
    alone = Renderer(
        scene, None, context, "complete", part=(number, 2), samples=samples, **OPTIONS, **more
    )
    try:
        return alone.render().image()
    finally:
        alone.release()


def assert_is(half: Half, image: Image) -> None:
    """Means agree to the digits of float32, variances to the digits left by a difference."""
    np.testing.assert_allclose(half.radiance, image.radiance, rtol=2e-5, atol=1e-6)
    np.testing.assert_allclose(half.variance, image.stderr**2, rtol=1e-3, atol=1e-6)
    for guide, name in zip(half.guides, ("albedo", "normal"), strict=True):
        aov = image.aovs[name]  # type: ignore[index]
        assert aov.stderr is not None
        np.testing.assert_allclose(guide.mean, aov.value, rtol=1e-5, atol=1e-6)
        np.testing.assert_allclose(guide.variance, aov.stderr**2, rtol=1e-3, atol=1e-6)


@pytest.mark.parametrize("caustics", ["off", "on"])
@pytest.mark.parametrize("samples", [64, 160])
def test_each_half_is_a_render_of_its_samples(
    context: Context, caustics: Any, samples: int
) -> None:
    """Particles too, whose film adds its variance."""
    with_both = Renderer(
        SCENE, None, context, "complete", samples=samples, caustics=caustics, **OPTIONS
    )
    first = with_both.render(samples // 2).image()
    halves = halves_of(first, with_both.render().image())
    with_both.release()
    for number, half in enumerate(halves, 1):
        assert half.share == 0.5
        assert_is(half, part(context, SCENE, number, samples, caustics=caustics))


def test_halves_need_not_be_equal(context: Context) -> None:
    with_both = Renderer(SCENE, None, context, "complete", samples=150, **OPTIONS)
    first = with_both.render(32).image()
    whole = with_both.render().image()
    with_both.release()
    one, rest = halves_of(first, whole)
    assert (one.share, rest.share) == (32 / 150, 118 / 150)
    mean = one.share * one.radiance.astype(float) + rest.share * rest.radiance
    np.testing.assert_allclose(mean, whole.radiance, rtol=1e-5, atol=1e-6)
    assert (rest.variance >= 0).all()
    ratio = rest.variance.mean() / one.variance.mean()
    assert 0.1 < ratio < 0.6, "more samples, less variance"
