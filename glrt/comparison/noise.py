"""How far two pictures differ in units of their noise, where noise may be rare and large.

Where few paths carry the light, dark means come with small errors: a pixel that was not hit claims
to know its value exactly. A test against the errors that pictures claim finds a difference between
almost any two of them. Two judges do better.

*Shuffled*: if both pictures draw their samples of a pixel in the same way, then chance alone has
dealt them out between the two. Given all samples, that fixes the variance of the difference, with
no estimate left in it, and bounds each step of the sum, whatever the distribution: a hit that only
one picture saw counts for both. The tail is Bernstein's inequality with the steps' third moment,
and a pixel's steps are taken as one.

*Own*: pictures of different methods have the noise that they claim, and the darker one may have
missed hits of the size that it saw. Where all its noise stands in a few pixels, that says nothing,
and the place has no vote. Both judges must agree on a difference.
"""

from collections.abc import Callable
from dataclasses import dataclass
from statistics import NormalDist
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Add = Callable[[Array], Array]  # sums pixels, (H, W, 3), over regions

BLOCK = 8  # pixels on a side
ROUNDING = 1e-5  # of the radiance: two programs may differ by that and be the same
FEWEST_PIXELS = 16  # that must carry the noise of a place before its own variance may judge it


@dataclass(frozen=True, eq=False)
class Pair:
    """Two pictures of one size, all arrays (H, W, 3).

    Radiance, the variance of each mean, and the samples a pixel; `alike` if both are of a method.
    `block`: how many samples make an independent observation in both.
    """

    image: Array
    reference: Array
    image_variance: Array
    reference_variance: Array
    image_samples: int
    reference_samples: int
    alike: bool
    block: int = 1

    @property
    def observations(self) -> float:
        """A pixel's in both pictures, which chance deals out: samples belong to their blocks."""
        return (self.image_samples + self.reference_samples) / self.block

    @property
    def difference(self) -> Array:
        """Image minus reference."""
        return self.image - self.reference

    @property
    def size(self) -> Array:
        """The larger of both, without sign."""
        return np.maximum(np.abs(self.image), np.abs(self.reference))

    @property
    def level(self) -> Array:
        """Mean of all samples of both; it stays the same however they are dealt out."""
        share = self.image_samples / (self.image_samples + self.reference_samples)
        return share * self.image + (1 - share) * self.reference

    @property
    def ratio(self) -> float:
        """Samples of the image for one of the reference."""
        return self.image_samples / self.reference_samples

    @property
    def shuffled_variance(self) -> Array:
        """Of the difference, if all observations of a pixel were dealt out anew."""
        between = np.square(self.difference) / self.observations
        return self.ratio * self.image_variance + self.reference_variance / self.ratio + between


class Judge(NamedTuple):
    """What chance can do to the summed difference of each region.

    `up` and `down` lower a score in standard errors, z, to z / sqrt(1 + up |z|): on the side where
    large steps make the tail heavier than that of a normal distribution. Infinite: no vote.
    """

    stderr: Array
    up: Array
    down: Array

    def score(self, difference: Array) -> Array:
        """Standard errors of a normal distribution that are as unlikely; 0 where there is none."""
        z = _ratio(difference, self.stderr)
        skew = np.where(z > 0, self.up, self.down)
        heavy = np.multiply(skew, np.abs(z), where=z != 0, out=np.zeros_like(z))
        return np.asarray(z / np.sqrt(1 + heavy))

    def reach(self, score: float) -> Array:
        """The difference that scores so much, on its heavier side."""
        skew = np.maximum(self.up, self.down) * score / 2
        z = score * (skew + np.sqrt(np.square(skew) + 1))
        return np.asarray(np.multiply(z, self.stderr, where=self.stderr > 0, out=np.zeros_like(z)))


def whole(pixels: Array) -> Array:
    """Sum of all pixels, (3,)."""
    return np.asarray(pixels.sum(axis=(0, 1)))


def edges(length: int) -> NDArray[np.intp]:
    """Where the blocks of a side begin, and its end; a remainder joins the last block."""
    starts = np.arange(max(length // BLOCK, 1), dtype=np.intp) * BLOCK
    return np.append(starts, length)


def blocks(pixels: Array) -> Array:
    """Sums of blocks of 8 x 8 pixels, (rows, columns, 3)."""
    rows, columns = (edges(length)[:-1] for length in pixels.shape[:2])
    return np.asarray(np.add.reduceat(np.add.reduceat(pixels, rows, axis=0), columns, axis=1))


def spread_out(values: Array, shape: tuple[int, ...]) -> Array:
    """The value of each pixel's block, for pictures of `shape`."""
    rows, columns = (np.diff(edges(length)) for length in shape[:2])
    return np.repeat(np.repeat(values, rows, axis=0), columns, axis=1)


class Sums:
    """Weighted sums of pixels over regions, against what chance does to them.

    Arrays have the shape that `add` gives. `score` is signed, and the mildest judge's; what lies
    within rounding scores 0.
    """

    def __init__(self, pair: Pair, add: Add, weight: Array | float = 1.0) -> None:
        self.difference = add(pair.difference * weight)
        self.reference = add(pair.reference * weight)
        self.rounding = ROUNDING * add(pair.size * weight)
        self._judges = [_shuffled(pair, add, weight)]
        if not pair.alike:
            self._judges.append(_own(pair, add, weight))
        beyond = np.maximum(np.abs(self.difference) - self.rounding, 0)
        found = [judge.score(np.copysign(beyond, self.difference)) for judge in self._judges]
        self.score = np.copysign(np.min(np.abs(found), axis=0), self.difference)

    def reach(self, score: float) -> Array:
        """The difference that the strictest judge scores so high, on its heavier side."""
        return np.asarray(np.max([judge.reach(score) for judge in self._judges], axis=0))

    def shown(self, score: float, power: float) -> float:
        """The smallest relative difference that exceeds a score with probability `power`."""
        noise = np.max([judge.stderr for judge in self._judges], axis=0)
        seen = self.reach(score) + NormalDist().inv_cdf(power) * noise + self.rounding
        lit = self.reference > 0
        return float(
            np.divide(seen, self.reference, where=lit, out=np.full_like(seen, np.inf)).min()
        )


def even_weights(pair: Pair) -> Array:
    """Weights of pixels that show best if one picture is brighter by a factor, (H, W, 3).

    They know only what stays the same however samples are dealt out: weights from the noise of
    one picture would favour blocks that are dark by chance.
    """
    variance = blocks(pair.shuffled_variance)
    level = np.maximum(blocks(pair.level), 0)
    weights = _ratio(level, variance + np.square(ROUNDING * level))
    return spread_out(weights / np.maximum(weights.max(axis=(0, 1)), 1e-300), pair.image.shape)


def _shuffled(pair: Pair, add: Add, weight: Array | float) -> Judge:
    """Its heavy side is that of the picture of fewer samples, whose hits take larger steps."""
    variance = pair.shuffled_variance * np.square(weight)
    total = add(variance)
    skew = _ratio(add(variance**1.5), total**1.5) * abs(pair.ratio**-0.5 - pair.ratio**0.5) / 3
    calm = np.zeros_like(skew)
    return Judge(np.sqrt(total), *((skew, calm) if pair.ratio < 1 else (calm, skew)))


def _own(pair: Pair, add: Add, weight: Array | float) -> Judge:
    image = pair.image_variance * np.square(weight)
    reference = pair.reference_variance * np.square(weight)
    total = add(image + reference)
    return Judge(np.sqrt(total), _missed(reference, total, add), _missed(image, total, add))


def _missed(variance: Array, total: Array, add: Add) -> Array:
    """The skew of a picture that may have missed hits of the size that it saw."""
    second, third = add(variance), add(variance**1.5)
    pixels = _ratio(second**3, third**2)  # as many, equally noisy, would do the same
    return np.where(pixels >= FEWEST_PIXELS, 2 / 3 * _ratio(third, total**1.5), np.inf)


def _ratio(above: Array, below: Array) -> Array:
    return np.divide(above, below, where=below > 0, out=np.zeros_like(above))
