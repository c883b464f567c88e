"""Films with every sample known: the truth for moments and merged pictures.

Samples are (n, H, W, C); NaN is one that was dropped. The sums are plain float64.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.image.aovs import AovImage
from glrt.image.film_state import FilmState
from glrt.image.image import Image
from glrt.image.moments import Moments
from glrt.image.partition import Partition, sample_range
from glrt.image.recipe import Recipe
from glrt.settings import Aov, Settings
from tests.support.images import recipe

Array = NDArray[np.float64]

BLOCK = 16  # samples of an observation
HEIGHT, WIDTH = 3, 4


def noise(samples: int, seed: int = 1, channels: int = 3) -> Array:
    """Skewed samples; each pixel has a brightness of its own."""
    random = np.random.default_rng(seed)
    bright = 10 ** random.uniform(-1, 2, (HEIGHT, WIDTH, channels))
    found: Array = bright * random.exponential(size=(samples, HEIGHT, WIDTH, channels))
    return found


def moments_of(samples: Array, block: int = BLOCK) -> Moments:
    """The moments that a film gathers of samples that begin with an observation."""
    whole = len(samples) // block * block
    counts, means = _means(samples[:whole].reshape(-1, block, *samples.shape[1:]), 1)
    is_there = counts > 0
    observations = is_there.sum(axis=0)
    _, center = _means(np.where(is_there, means, np.nan), 0)
    squares = np.where(is_there, means - center, 0) ** 2
    variance = squares.sum(axis=0) / np.maximum(observations, 1)
    count, mean = _means(samples, 0)
    begun, part = _means(samples[whole:], 0)
    return Moments(count, mean, observations.astype(float), variance, begun, part)


def _means(values: Array, axis: int) -> tuple[Array, Array]:
    """How many samples are finite, of all channels, and their mean; 0 of none."""
    finite = np.isfinite(values).all(axis=-1, keepdims=True)
    count = finite.sum(axis=axis).astype(float)
    return count, np.where(finite, values, 0).sum(axis=axis) / np.maximum(count, 1)


def error_of(samples: Array, block: int = BLOCK) -> Array:
    """The standard error of the mean, by the formula for a part of an observation."""
    found = moments_of(samples, block)
    whole = np.maximum(found.samples - found.begun, 1)
    mean = (found.mean * found.samples - found.part * found.begun) / whole
    share = found.begun / np.maximum(found.samples, 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        of_whole = found.variance / (found.observations - 1)
    square = np.maximum(1 - 2 * share, 0) * of_whole + (share * (found.part - mean)) ** 2
    return np.where(found.observations >= 2, np.sqrt(square), np.nan)


# --- pictures ----------------------------------------------------------------------------------


class Render(NamedTuple):
    """A render with every sample of radiance and of AOVs known."""

    samples: Array
    aovs: dict[Aov, Array]  # of whole observations

    def part(self, number: int, count: int, **changes: Any) -> Image:
        """One of its parts as a film holds it, in float32."""
        settings: dict[str, Any] = {"width": WIDTH, "height": HEIGHT, "aov": tuple(self.aovs)}
        total = len(self.samples)
        whole = Settings(samples=total, **settings)
        partition = Partition(count=count, numbers=(number,))
        numbers = sample_range(partition, number, whole)
        own = recipe(samples=total, **settings)
        update = {"partition": partition, "samples": len(numbers), **changes}
        film = self.samples[numbers.start : numbers.stop]
        end = -(-numbers.stop // BLOCK) * BLOCK
        aovs = {name: aov_of(name, raw[numbers.start : end]) for name, raw in self.aovs.items()}
        return picture_of(film, own.model_copy(update=update), aovs)


def render_of(samples: int, *aovs: Aov, seed: int = 1) -> Render:
    """A render with AOVs of their usual shapes; no sample is dropped."""
    whole = -(-samples // BLOCK) * BLOCK
    shapes = {name: 1 if name in ("depth", "object", "bounces") else 3 for name in aovs}
    return Render(
        noise(samples, seed),
        {name: noise(whole, seed + 1 + n, shapes[name]) for n, name in enumerate(aovs)},
    )


def picture_of(samples: Array, of: Recipe, aovs: dict[Aov, AovImage] | None = None) -> Image:
    """The picture of a film of these samples."""
    found = moments_of(samples)
    dropped = len(samples) - found.samples
    planes = (x[..., 0] for x in (dropped, found.observations, found.begun))
    lost, observations, begun = (single(x) for x in planes)
    state = FilmState(single(found.variance), lost, observations, single(found.part), begun)
    error = single(error_of(samples))
    return Image(single(found.mean), error, len(samples), of, state, aovs or {})


def single(values: Array) -> NDArray[np.float32]:
    """Rounded to float32."""
    return values.astype(np.float32)


def aov_of(name: Aov, samples: Array) -> AovImage:
    """An AOV of these samples."""
    if name == "object":
        return AovImage(np.arange(HEIGHT * WIDTH, dtype=np.uint32).reshape(HEIGHT, WIDTH))
    found, error = moments_of(samples), single(error_of(samples))
    value = single(found.mean)
    if name == "depth":
        value = np.where(found.samples > 0, value, np.float32(np.inf))[..., 0]
        error = error[..., 0]
    counts = (x[..., 0].astype(np.uint32) for x in (found.samples, found.observations))
    return AovImage(value, error, *counts)
