"""Pictures of a gradient under noise of several kinds, for tests of comparisons."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from glrt.image.image import Image
from tests.support.alarms import ALPHA, book


class Kind(NamedTuple):
    """Radiance without hits, its deviation; how many samples are hits, what a hit brings, where."""

    base: float
    deviation: float
    share: float = 0.0
    hit: float = 0.0
    first_row: float = 0.0  # of the rows: hits fall below it


KINDS = {
    "smooth": Kind(0.5, 0.15),
    "caustic": Kind(0.5, 0.15, 1e-4, 400.0, 0.75),
    "small lamp": Kind(0.0, 0.0, 4e-4, 1000.0),
    "lamp": Kind(0.0, 0.0, 7e-3, 60.0),
}
MIXES = [(64, 64), (16, 256), (64, 4096)]


def noisy(name: str, samples: int, seed: int, size: int = 32, factor: float = 1.0) -> Image:
    """A gradient seen through noise; the channels share their hits."""
    draw = np.random.default_rng([seed, samples])
    kind = KINDS[name]
    level = factor * np.linspace(0.6, 1.4, size)[:, None, None] * np.array([1.0, 0.8, 0.6])
    share = np.where(np.arange(size) >= kind.first_row * size, kind.share, 0)[:, None, None]
    hits = draw.poisson(samples * share, (size, size, 1)) / samples
    smooth = kind.base + kind.deviation * draw.normal(size=(size, size, 3)) / math.sqrt(samples)
    variance = kind.deviation**2 * draw.chisquare(samples - 1, (size, size, 3)) / samples
    variance += kind.hit**2 * hits * (1 - hits)
    stderr = level * np.sqrt(variance / (samples - 1))
    radiance = level * (smooth + kind.hit * hits)
    return Image(radiance.astype(np.float32), stderr.astype(np.float32), samples)


def flat(radiance: float, stderr: float, samples: int, size: int = 16) -> Image:
    pixels = np.ones((size, size, 3), np.float32)
    return Image(radiance * pixels, stderr * pixels, samples)


def red(image: Image) -> Image:
    """The image without its other channels."""
    only = np.array([1, 0, 0], np.float32)
    return replace(image, radiance=image.radiance * only, stderr=image.stderr * only)


def alarms_allowed(pairs: int, alpha: float) -> int:
    """As many or fewer happen in all but one in 10 million sets of pairs."""
    book()
    below = 0.0
    for count in range(pairs + 1):
        below += math.comb(pairs, count) * alpha**count * (1 - alpha) ** (pairs - count)
        if below >= 1 - ALPHA:
            return count
    return pairs
