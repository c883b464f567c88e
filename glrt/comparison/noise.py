"""How far two pictures differ in units of their noise, where noise may be rare and large.

Where few paths carry the light, dark means come with small errors: a pixel that was not hit claims
to know its value exactly. A test against the errors that pictures claim finds a difference between
almost any two of them. Two judges do better.

*Shuffled*: if both pictures draw their samples of a pixel in the same way, then chance alone has
dealt the samples out between the two. Given all samples, that fixes the variance of the difference,
without any estimate. It also bounds each step of the sum, whatever the distribution: a hit that
only one picture saw counts for both. The tail is Bernstein's inequality with the third moment of
the steps, and all steps of a pixel count as one.

*Own*: pictures of different methods have the noise that they claim, and the darker one may have
missed hits of the size that it saw. Rare light that it met anywhere (rare_light.py) it may have
missed here: each place has at least its share of that light. A place where all noise is in a few
pixels has no vote, since its claim says nothing. Both judges must agree on a difference.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

from glrt.comparison.regions import Add, Array, blocks, edges, ratio_of, spread_out

FAR = 16.0  # times the variance that is usual in a place


def rare_variance(variance: Array, other: Array) -> Array:
    """The variance of the pixels that met rare light, 0 elsewhere, (H, W, 3).

    `variance` is that of the means of a picture's pixels. `other` is that of another picture's,
    scaled to as many samples per pixel.
    """
    usual = spread_out(_largest_around(_medians(variance)), variance.shape)
    return np.where(variance > FAR * np.maximum(usual, other), variance, 0.0)


def _medians(pixels: Array) -> Array:
    """Medians of the blocks, (rows, columns, 3)."""
    rows, columns = edges(pixels.shape[0]), edges(pixels.shape[1])
    bands = [pixels[top:end] for top, end in pairwise(rows)]
    sides = list(pairwise(columns))
    return np.array([[np.median(band[:, i:j], axis=(0, 1)) for i, j in sides] for band in bands])


def _largest_around(values: Array) -> Array:
    """The maximum over each block and its eight neighbours."""
    rows, columns = values.shape[:2]
    framed = np.pad(values, ((1, 1), (1, 1), (0, 0)), mode="edge")
    shifted = [framed[y : y + rows, x : x + columns] for y in range(3) for x in range(3)]
    return np.asarray(np.max(shifted, axis=0))


ROUNDING = 1e-5  # of the radiance: two equal pictures of different programs may differ by that
CALM = 1 / 30  # of the usual relative noise: below it, the camera sees a lamp or the sky itself
FEWEST_PIXELS = 16  # that must carry the noise of a place before its own variance may judge it


@dataclass(frozen=True, eq=False)
class Pair:
    """Two pictures of one size; all arrays are (H, W, 3).

    They are radiance, and the variance of each mean; `alike` if both pictures have the same method.
    `block`: how many samples make an independent observation in both.
    """

    image: Array
    reference: Array
    image_variance: Array
    reference_variance: Array
    image_samples: int
    reference_samples: int
    alike: bool
    block: float = 1

    @property
    def observations(self) -> float:
        """Observations of a pixel in both pictures, which chance deals out as whole blocks."""
        return (self.image_samples + self.reference_samples) / self.block

    @property
    def difference(self) -> Array:
        """Image minus reference."""
        return self.image - self.reference

    @property
    def size(self) -> Array:
        """The larger magnitude of both."""
        return np.maximum(np.abs(self.image), np.abs(self.reference))

    @property
    def level(self) -> Array:
        """Mean of all samples of both; it stays the same however they are dealt out."""
        share = self.image_samples / (self.image_samples + self.reference_samples)
        return share * self.image + (1 - share) * self.reference

    @property
    def ratio(self) -> float:
        """Samples of the image for each sample of the reference."""
        return self.image_samples / self.reference_samples

    @cached_property
    def image_rare(self) -> Array:
        """The image's variance in pixels that met rare light; 0 elsewhere."""
        return rare_variance(self.image_variance, self.reference_variance / self.ratio)

    @cached_property
    def reference_rare(self) -> Array:
        """The reference's variance in pixels that met rare light; 0 elsewhere."""
        return rare_variance(self.reference_variance, self.image_variance * self.ratio)

    @property
    def shuffled_variance(self) -> Array:
        """Variance of the difference, if all observations of a pixel were dealt out again."""
        between = np.square(self.difference) / self.observations
        return self.ratio * self.image_variance + self.reference_variance / self.ratio + between


class Judge(NamedTuple):
    """The effect of chance on the summed difference of each region.

    `up` and `down` lower a score in standard errors, z, to z / sqrt(1 + up |z|), on the side where
    large steps make the tail heavier than that of a normal distribution. Infinite: no vote.
    """

    stderr: Array
    up: Array
    down: Array

    def score(self, difference: Array) -> Array:
        """The score of a normal distribution that is as unlikely; 0 where `stderr` is 0."""
        z = ratio_of(difference, self.stderr)
        skew = np.where(z > 0, self.up, self.down)
        heavy = np.multiply(skew, np.abs(z), where=z != 0, out=np.zeros_like(z))
        return np.asarray(z / np.sqrt(1 + heavy))

    def reach(self, score: float) -> Array:
        """The difference that has this score, on its heavier side."""
        skew = np.maximum(self.up, self.down) * score / 2
        z = score * (skew + np.sqrt(np.square(skew) + 1))
        return np.asarray(np.multiply(z, self.stderr, where=self.stderr > 0, out=np.zeros_like(z)))


class Sums:
    """Weighted sums of pixels over regions, and their scores against chance.

    Arrays have the shape that `add` gives. `score` is signed, and the mildest judge's; a difference
    within rounding scores 0.
    """

    def __init__(self, pair: Pair, add: Add, weight: Array | float = 1.0) -> None:
        self._add, self._weight = add, weight
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

    def factor_found(self, change: Array, score: float, power: float) -> Array:
        """The share of `change`, (H, W, 3), that each region finds with probability `power`.

        It is found if the sum exceeds the score on its heavier side. Infinite where `change` is 0.
        """
        noise = np.max([judge.stderr for judge in self._judges], axis=0)
        seen = self.reach(score) + NormalDist().inv_cdf(power) * noise + self.rounding
        signal = np.abs(self._add(change * self._weight))
        none = np.full_like(seen, np.inf)
        return np.asarray(np.divide(seen, signal, where=signal > 0, out=none))


def even_weights(pair: Pair) -> Array:
    """Weights of pixels that show best if one picture is brighter by a factor, (H, W, 3).

    They use only what stays the same however samples are dealt out: weights from the noise of one
    picture would favour blocks that are dark by chance. Blocks with a relative noise below CALM of
    the usual one have no weight: all of it would be theirs, and the factor that of lamps in view.
    """
    variance = blocks(pair.shuffled_variance)
    level = np.maximum(blocks(pair.level), 0)
    weights = ratio_of(level, variance + np.square(ROUNDING * level))
    noise = ratio_of(np.sqrt(variance), level)
    usual = np.quantile(noise[noise > 0], 0.9) if noise.any() else 0.0
    weights = np.where(noise >= CALM * usual, weights, 0.0)
    return spread_out(weights / np.maximum(weights.max(axis=(0, 1)), 1e-300), pair.image.shape)


def _shuffled(pair: Pair, add: Add, weight: Array | float) -> Judge:
    """The shuffled judge; its heavy side is that of fewer samples, whose hits are larger steps."""
    variance = pair.shuffled_variance * np.square(weight)
    total = add(variance)
    skew = ratio_of(add(variance**1.5), total**1.5) * abs(pair.ratio**-0.5 - pair.ratio**0.5) / 3
    calm = np.zeros_like(skew)
    return Judge(np.sqrt(total), *((skew, calm) if pair.ratio < 1 else (calm, skew)))


def _own(pair: Pair, add: Add, weight: Array | float) -> Judge:
    image = _Claim(pair.image_variance, pair.image_rare, add, weight)
    reference = _Claim(pair.reference_variance, pair.reference_rare, add, weight)
    total = image.second + reference.second
    return Judge(np.sqrt(total), reference.missed(total), image.missed(total))


class _Claim:
    """The claimed noise of a picture's regions: the variance of sums, and what they may miss."""

    def __init__(self, variance: Array, rare: Array, add: Add, weight: Array | float) -> None:
        variance, rare = variance * np.square(weight), rare * np.square(weight)
        share = add(np.ones_like(rare)) / rare[..., 0].size  # of all pixels
        second, third = add(variance), add(variance**1.5)
        self.pixels = ratio_of(second**3, third**2)  # equally noisy pixels with the same sums
        self.second, self.third = (
            own + np.maximum(share * rare_power.sum(axis=(0, 1)) - add(rare_power), 0)
            for own, rare_power in ((second, rare), (third, rare**1.5))
        )

    def missed(self, total: Array) -> Array:
        """The skew of a picture that may have missed hits of the size that it saw."""
        skew = 2 / 3 * ratio_of(self.third, total**1.5)
        return np.where(self.pixels >= FEWEST_PIXELS, skew, np.inf)
