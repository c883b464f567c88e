"""Mix the unfiltered picture in where a filter would make it worse.

Half of the samples have a mean A of variance V about the truth, and a filter returns D. Where D is
right, (D - A)^2 is V (1 - 2 w) on average, with w the weight of a pixel's own noise in D. The
excess is the square of the filter's bias, in light that no guide knows, as under a caustic or in a
shadow. The result is A + alpha (D - A), with the alpha that makes the sum of both squares least.
All of this is taken from one half, so that the other half can judge the result.

Averages are taken over neighbours that look alike in D and in its guides: a lamp or a sky without
noise is not judged by the wall next to it, and the pixels of an edge by others of that edge. A
pixel with few alike neighbours is judged by little: there a filter is trusted less.

Wiener (1949) for alpha; Stein, "Estimation of the Mean of a Multivariate Normal Distribution"
(1981), for the mean of (D - A)^2 without bias; Tomasi and Manduchi, "Bilateral Filtering for Gray
and Color Images" (1998), for means over alike neighbours.
"""

import numpy as np

from glrt.denoise.filters import Filtered
from glrt.denoise.half import Half, Pixels
from glrt.denoise.windows import Array, pairs

REACH = 3  # pixels: squares are averaged over 7 x 7
SPARED = 0.5  # of the variance: a smaller excess of the squares is taken for chance
ALIKE = 0.25  # difference of guides, or of logarithms of D, that makes a weight of 1 / e
FLAW = 0.01  # of a filter's result: it may be wrong by that anywhere
DARK = 0.02  # of the mean of D: differences of darker pixels count less


def blended(half: Half, found: Filtered) -> Pixels:
    """The filtered half, or less of it where the filter errs by more than the noise; (H, W, 3)."""
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
    """Features by which neighbours are compared, (H, W, 9), in units of `ALIKE`."""
    light = np.maximum(radiance, 0)
    floor = max(DARK * float(light.mean()), float(np.finfo(np.float32).tiny))
    parts = np.log(light + floor), half.albedo.mean, half.normal.mean
    return np.concatenate(parts, axis=-1, dtype=np.float32) / np.float32(ALIKE)


def _mean_of_alike(planes: Array, looks: Pixels) -> tuple[Array, Array]:
    """Means of planes (N, H, W) over alike neighbours, and the sums of their weights, (H, W)."""
    total, weights = planes.copy(), np.ones(planes.shape[1:])
    for here, there in pairs(planes.shape[1:], REACH):
        apart = looks[here] - looks[there]
        weight = np.exp(-np.einsum("...i,...i", apart, apart))
        total[:, *here] += weight * planes[:, *there]
        total[:, *there] += weight * planes[:, *here]
        weights[here] += weight
        weights[there] += weight
    return total / weights, weights
