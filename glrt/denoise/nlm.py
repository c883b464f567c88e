"""Joint non-local means: each pixel becomes a mean of pixels whose surroundings look alike.

Colours are compared by patches, guides by pixels. Distances are in units of the noise, less the
distance that noise alone makes. So a difference within the noise has weight 1, whatever the noise.
The weights are symmetric, so each pair of pixels is compared once.

Buades, Coll and Morel, "A Non-Local Algorithm for Image Denoising" (2005); Rousselle, Knaus and
Zwicker, "Adaptive Rendering with Non-Local Means Filtering" (2012), equations 3 to 5; Rousselle,
Manzi and Zwicker, "Robust Denoising using Feature and Color Information" (2013), equations 6 to 9.
"""

import numpy as np
from numpy.typing import NDArray

from glrt.denoise.half import Guide, Half, Pixels
from glrt.denoise.windows import Place, pairs, window_mean

REACH = 7  # of the window in pixels: how far a pixel looks
PATCH = 2  # of a patch: 5 x 5 pixels are compared at once
NOISE_REACH = 1  # pixels over which variances are averaged: those of few observations are rough
COLOR = 0.8  # a distance of colours, in standard deviations, that makes a weight of 1 / e
GUIDE = 1.5  # the same distance for guides
LEAST = 3e-3  # variance of guides below which they count as equal
NO_NOISE = 1e-10  # variance added to those of colours, in squared units of radiance

Plane = NDArray[np.float32]


def filtered(half: Half) -> tuple[Pixels, Plane]:
    """The filtered radiance, (H, W, 3), and the weight of each pixel in its own mean, (H, W)."""
    color, variance = half.radiance, window_mean(half.variance, NOISE_REACH)
    spans = [_span(guide) for guide in half.guides]
    total = color.astype(np.float64)
    weights = np.ones(color.shape[:2])
    for here, there in pairs(color.shape[:2], REACH):
        weight = _alike(color, variance, here, there)
        for guide, span in zip(half.guides, spans, strict=True):
            np.minimum(weight, _same_surface(guide, span, here, there), out=weight)
        total[here] += weight[..., None] * color[there]
        total[there] += weight[..., None] * color[here]
        weights[here] += weight
        weights[there] += weight
    mean = total / weights[..., None]
    return mean.astype(np.float32), (1 / weights).astype(np.float32)


def _alike(color: Pixels, variance: Pixels, here: Place, there: Place) -> Plane:
    """Weights of pairs of pixels by colour, from the patches around them."""
    a, b = variance[here], variance[there]
    apart = np.square(color[here] - color[there]) - 2 * np.minimum(a, b)
    distance = apart / (COLOR**2 * (a + b) + NO_NOISE)
    mean = window_mean(distance.mean(axis=-1), PATCH)
    return np.asarray(np.exp(-np.maximum(mean, 0)), np.float32)


def _span(guide: Guide) -> Pixels:
    """The unit of differences of a guide: its variance, or its squared slope if that is more."""
    slope = _step(guide.mean, 0) + _step(guide.mean, 1)
    return np.asarray(np.maximum(np.maximum(guide.variance, slope), LEAST), np.float32)


def _step(mean: Pixels, axis: int) -> Pixels:
    """Square of the smaller step to the two neighbours: small at an edge, large on a slope."""
    steps = np.square(np.diff(mean, axis=axis))
    none = np.full_like(mean.take([0], axis), np.inf)
    before, after = np.concatenate([none, steps], axis), np.concatenate([steps, none], axis)
    least = np.minimum(before, after)
    return np.where(np.isinf(least), np.float32(0), least)


def _same_surface(guide: Guide, span: Pixels, here: Place, there: Place) -> Plane:
    """Weights of pairs of pixels by one guide."""
    a, b = guide.variance[here], guide.variance[there]
    apart = np.square(guide.mean[here] - guide.mean[there]) - 2 * np.minimum(a, b)
    distance = apart / (GUIDE**2 * np.minimum(span[here], span[there]))
    return np.asarray(np.exp(-np.maximum(distance.max(axis=-1), 0)), np.float32)
