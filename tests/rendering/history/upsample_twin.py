"""One coarse picture without history as upsample.frag reconstructs it, in float64."""

from typing import NamedTuple

import numpy as np

from tests.rendering.history.twins import Array

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


class Twin(NamedTuple):
    """The mean around each pixel and the picture, (H, W, 3), and their samples, (H, W)."""

    guess: Array
    guessed: Array  # samples
    shown: Array
    stands_for: Array  # samples


def reconstructed(pairs: Array, objects: Array, corner: tuple[int, int], k: int) -> Twin:
    """The picture of `pairs` of samples (2, H, W, 3), read at sampled pixels; `objects` (H, W)."""
    height, width = objects.shape
    found = Twin(*(np.zeros((height, width, *more)) for more in ((3,), (), (3,), ())))
    for y, x in np.ndindex(height, width):
        near = _near(x, y, objects, corner, k)
        weights = np.array([np.exp(-2 * ((i - x) ** 2 + (j - y) ** 2) / k**2) for i, j in near])
        both = np.array([pairs[:, j, i] for i, j in near])
        total, squares = weights.sum(), (weights**2).sum()
        guess = weights @ both.mean(axis=1) / total
        guessed = 2 * total**2 / squares
        found.guess[y, x], found.guessed[y, x] = guess, guessed
        found.shown[y, x], found.stands_for[y, x] = guess, guessed
        if (x - corner[0]) % k or (y - corner[1]) % k:
            continue
        prior = _prior(both @ LUMINANCE, weights, guessed)
        own = pairs[:, y, x].mean(axis=0)
        found.shown[y, x] = (2 * own + prior * guess) / (2 + prior)
        found.stands_for[y, x] = 2 + prior
    return found


def _near(x: int, y: int, objects: Array, corner: tuple[int, int], k: int) -> list[tuple[int, int]]:
    """The sampled pixels of the same object in the nearest 3 x 3."""
    height, width = objects.shape
    middle = [
        int(np.floor((at - first + k / 2) / k)) for at, first in zip((x, y), corner, strict=True)
    ]
    places = [
        (corner[0] + k * (middle[0] + i), corner[1] + k * (middle[1] + j))
        for j in (-1, 0, 1)
        for i in (-1, 0, 1)
    ]
    inside = [(i, j) for i, j in places if 0 <= i < width and 0 <= j < height]
    return [(i, j) for i, j in inside if objects[j, i] == objects[y, x]]


def _prior(lumas: Array, weights: Array, guessed: float) -> float:
    """Samples that the mean around counts for; `lumas` (n, 2) of the pairs."""
    total = weights.sum()
    shared = (weights**2).sum() / total**2
    if len(lumas) < 2:
        return 0.0
    means = lumas.mean(axis=1)
    variance = weights @ (means - weights @ means / total) ** 2 / total / (1 - shared)
    noise = weights @ (lumas[:, 0] - lumas[:, 1]) ** 2 / 2 / total
    detail = max(variance - noise, 0.0)  # twice the noise of a mean of two
    return float(noise / (detail + noise / guessed)) if noise > 0 else 0.0
