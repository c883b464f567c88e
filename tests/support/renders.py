"""Scenes rendered for tests, and what the noise of the pictures allows to say.

Chance fails a verdict once in 10 million seeds (tests/support/alarms.py); the seeds are fixed.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from glrt.error.estimate import block_means, block_stderr, sidak_threshold
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Sampler
from tests.support.alarms import ALPHA, book
from tests.support.images import same_bits
from tests.support.z_scores import z_test

METHODS = ("naive", "nee", "mis")
SAMPLERS: tuple[Sampler, ...] = ("independent", "sobol")
ENOUGH = 500  # effective samples behind a mean before its own variance may judge it

Floats = NDArray[np.float64]


class Estimate(NamedTuple):
    """Means with their standard errors, of one shape; the last axis is the channel."""

    mean: Floats
    stderr: Floats


@contextmanager
def rendering(scene: Scene, context: Context, **settings: Any) -> Iterator[Renderer]:
    """A renderer of 16 x 16 pixels (or as `settings` say) that must drop no sample.

    By default it uses independent numbers: then a few samples know their error.
    """
    usual = {"width": 16, "height": 16, "sampler": "independent"}
    renderer = Renderer(scene, context=context, **{**usual, **settings})
    try:
        yield renderer
        assert not renderer.samples or renderer.nonfinite() == 0
    finally:
        renderer.release()


def rendered(scene: Scene, context: Context, samples: int = 1, **settings: Any) -> Image:
    """The picture of `rendering` after `samples` samples."""
    with rendering(scene, context, **settings) as renderer:
        return renderer.render(samples).image()


def whole(image: Image) -> Estimate:
    """Mean of all pixels, (3,)."""
    pixels = image.radiance[..., 0].size
    spread = np.square(image.stderr, dtype=np.float64).sum(axis=(0, 1))
    return Estimate(image.radiance.mean(axis=(0, 1), dtype=np.float64), np.sqrt(spread) / pixels)


def blocks(image: Image, size: int = 8) -> Estimate:
    """Means of blocks of size x size pixels."""
    return Estimate(block_means(image.radiance, size), block_stderr(image.stderr, size))


def assert_mean(estimate: Estimate, truth: ArrayLike, within: float, floor: float = 0.0) -> None:
    """The z-test passes, and its interval is narrow: half of it is at most `within` x truth.

    `floor` is the part of the standard error that the estimate does not know, such as rounding.
    """
    book()
    verdict = z_test(*estimate, truth, ALPHA, floor)
    assert verdict, f"{verdict}: {estimate.mean.ravel()[:12]} against {np.ravel(truth)[:12]}"
    half = interval(verdict.tests) * np.maximum(estimate.stderr, floor)
    assert (half <= within * np.abs(truth)).all(), f"{half.max()} too wide for {np.ravel(truth)}"


def same(a: Image, b: Image) -> bool:
    """Whether radiance and standard error agree in every bit."""
    return same_bits(a.radiance, b.radiance) and same_bits(a.stderr, b.stderr)


def interval(tests: int) -> float:
    """Standard errors on either side that `tests` tests together allow."""
    return NormalDist().inv_cdf(1 - sidak_threshold(ALPHA, tests) / 2)


def difference(a: Estimate, b: Estimate) -> Estimate:
    """a - b of independent estimates."""
    return Estimate(a.mean - b.mean, np.hypot(a.stderr, b.stderr))


def effective_samples(estimate: Estimate, samples: int) -> Floats:
    """(sum x)^2 / sum x^2 over `samples` samples: how many equal hits would be as noisy."""
    square = np.square(estimate.mean)
    variance = np.square(estimate.stderr) * samples
    effective: Floats = samples * square / np.maximum(square + variance, 1e-300)
    return effective


def assert_agree(a: Image, b: Image, within: float) -> None:
    """Two pictures of one scene, of different seeds, have equal means: in blocks and as a whole.

    Blocks are the smallest whose mean rests on ENOUGH effective samples in both: a variance
    measured over a handful of hits misses the hits that did not come.
    """
    size = next(size for size in (4, 8, 16, 32, 64) if _is_sure(a, size) and _is_sure(b, size))
    book()
    parts = difference(blocks(a, size), blocks(b, size))
    verdict = z_test(*parts, 0, ALPHA / 2)
    assert verdict, f"{verdict} among blocks of {size}"
    total = difference(whole(a), whole(b))
    verdict = z_test(*total, 0, ALPHA / 2)
    assert verdict, f"{verdict} of the whole: {whole(a).mean} against {whole(b).mean}"
    half = interval(3) * total.stderr / whole(b).mean
    assert (half <= within).all(), f"the test sees no bias below {half}"


def _is_sure(image: Image, size: int) -> bool:
    height, width = image.radiance.shape[:2]
    assert size <= min(height, width), "too few samples for any test"
    estimate = blocks(image, size)
    effective = effective_samples(estimate, size * size * image.samples)
    return bool((effective >= ENOUGH).all())
