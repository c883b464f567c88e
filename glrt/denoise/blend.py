"""The picture as it was, where a filter would make it worse.

In half of the samples, with a mean A of variance V about the truth, a filter returns D. Where D is
right, (D - A)^2 is V (1 - 2 w) on average, with w the weight of a pixel's own noise in D. What lies
beyond that is the square of what the filter makes wrong: its bias, in light that no guide knows, as
under a caustic or in a shadow. Shown is A + alpha (D - A), with the alpha that makes the sum of
both squares least. Everything is taken from the one half, so the other one can judge the result.

Wiener (1949) for alpha; Stein, "Estimation of the Mean of a Multivariate Normal Distribution"
(1981), for what (D - A)^2 is without bias.
"""

import numpy as np

from glrt.denoise.filters import Filtered
from glrt.denoise.half import Half, Pixels
from glrt.denoise.windows import Array, window_mean

REACH = 3  # pixels: squares are averaged over 7 x 7
SPARED = 0.3  # of the variance: a smaller excess of the squares is taken for chance


def blended(half: Half, found: Filtered) -> Pixels:
    """The half filtered, but less where the filter errs by more than the noise; (H, W, 3)."""
    alpha = trust(half, found)[..., None]
    return np.asarray(half.radiance + alpha * (found.radiance - half.radiance), np.float32)


def trust(half: Half, found: Filtered) -> Array:
    """Alpha of each pixel, (H, W) float32: 1 where the filter is right, 0 where it does harm."""
    own = found.own_weight[..., None]
    apart = _local(np.square(found.radiance - half.radiance))
    noise = _local(half.variance * (1 - own))
    expected = _local(half.variance * (1 - 2 * own))
    wrong = np.maximum(apart - expected - SPARED * noise, 0)
    whole = noise + wrong
    alpha = np.divide(noise, whole, out=np.zeros_like(whole), where=whole > 0)
    return np.asarray(alpha, np.float32)


def _local(squares: Array) -> Array:
    """Mean over channels and neighbours, (H, W) float64."""
    return window_mean(squares.mean(axis=-1, dtype=np.float64), REACH)
