"""The picture as it was, where a filter would make it worse.

In half of the samples, with a mean A of variance V about the truth, a filter returns D. Where D is
right, (D - A)^2 is V (1 - 2 w) on average, with w the weight of a pixel's own noise in D. What lies
beyond that is the square of what the filter makes wrong: its bias, in light that no guide knows, as
under a caustic or in a shadow. Shown is A + alpha (D - A), with the alpha that makes the sum of
both squares least. Everything is taken from the one half, so the other one can judge the result.

Averages are taken over neighbours that look alike in D and in its guides: a lamp or a sky without
noise is not judged by the wall beside it, and the pixels of an edge by others of that edge. What
few look like is judged by little: there a filter is trusted less.

Wiener (1949) for alpha; Stein, "Estimation of the Mean of a Multivariate Normal Distribution"
(1981), for what (D - A)^2 is without bias; Tomasi and Manduchi, "Bilateral Filtering for Gray and
Color Images" (1998), for means over what looks alike.
"""

import numpy as np

from glrt.denoise.filters import Filtered
from glrt.denoise.half import Half, Pixels
from glrt.denoise.windows import Array, pairs

REACH = 3  # pixels: squares are averaged over 7 x 7
SPARED = 0.5  # of the variance: a smaller excess of the squares is taken for chance
ALIKE = 0.25  # difference of guides, or of logarithms of D, that makes a weight of 1 / e
FLAW = 0.01  # of what a filter shows: it may be wrong by that anywhere
DARK = 0.02  # of the mean of D: differences of what is darker count less


def blended(half: Half, found: Filtered) -> Pixels:
    """The half filtered, but less where the filter errs by more than the noise; (H, W, 3)."""
    alpha = trust(half, found)[..., None]
    return np.asarray(half.radiance + alpha * (found.radiance - half.radiance), np.float32)


def trust(half: Half, found: Filtered) -> Array:
    """Alpha of each pixel, (H, W) float32: 1 where the filter is right, 0 where it does harm."""
    own = found.own_weight[..., None]
    squares = (
        np.square(found.radiance - half.radiance),
        half.variance * (1 - own),
        half.variance * (1 - 2 * own),
        np.square(FLAW * found.radiance),
    )
    planes = np.stack([square.mean(axis=-1, dtype=np.float64) for square in squares])
    (apart, noise, expected, flaw), count = _mean_of_alike(planes, _looks(half, found.radiance))
    wrong = np.maximum(apart - expected - SPARED * noise, 0)
    whole = noise + wrong + flaw + noise / count
    alpha = np.divide(noise, whole, out=np.zeros_like(whole), where=noise > 0)
    return np.asarray(alpha, np.float32)


def _looks(half: Half, radiance: Pixels) -> Pixels:
    """What neighbours are compared by, (H, W, 9), in units of `ALIKE`."""
    light = np.maximum(radiance, 0)
    floor = max(DARK * float(light.mean()), float(np.finfo(np.float32).tiny))
    parts = np.log(light + floor), half.albedo.mean, half.normal.mean
    return np.concatenate(parts, axis=-1, dtype=np.float32) / np.float32(ALIKE)


def _mean_of_alike(planes: Array, looks: Pixels) -> tuple[Array, Array]:
    """Means of planes (N, H, W) over neighbours as they look alike, and of how many, (H, W)."""
    total, weights = planes.copy(), np.ones(planes.shape[1:])
    for here, there in pairs(planes.shape[1:], REACH):
        apart = looks[here] - looks[there]
        weight = np.exp(-np.einsum("...i,...i", apart, apart))
        total[:, *here] += weight * planes[:, *there]
        total[:, *there] += weight * planes[:, *here]
        weights[here] += weight
        weights[there] += weight
    return total / weights, weights
