"""The passes of weighted recursive least squares on a still picture of one object, in numpy."""

from typing import Any

import numpy as np

from tests.rendering.history.twins import LEAST, Array, FactoredWrls, _windows


def reconstructed(light: Array, counts: Array, objects: Array, samples: float) -> Array:
    """Radiance (H, W, 3) under a Gaussian of half a pixel, of the same object alone."""
    height, width, _ = light.shape
    total, weights = np.zeros((height, width, 3)), np.zeros((height, width, 1))
    for j in (-1, 0, 1):
        for i in (-1, 0, 1):
            rows = slice(max(0, -j), height - max(0, j))
            columns = slice(max(0, -i), width - max(0, i))
            there = slice(max(0, j), height + min(0, j)), slice(max(0, i), width + min(0, i))
            is_alike = (objects[rows, columns] == objects[there]) & (counts[there] > 0)
            usual = np.exp(-2 * (i * i + j * j)) * (min(2 / samples, 1) if i or j else 1)
            weight = np.where(is_alike, usual, 0)[..., None]
            total[rows, columns] += weight * light[there]
            weights[rows, columns] += weight
    return total / np.where(weights > 0, weights, 1)


def smoothed(predictions: Array, features: Array) -> Array:
    """The bilateral mean over 5 x 5 pixels, (H, W, 3)."""
    height, width, _ = predictions.shape
    found = np.zeros((height, width, 3))
    for y in range(height):
        for x in range(width):
            rows = slice(max(y - 2, 0), y + 3)
            columns = slice(max(x - 2, 0), x + 3)
            v, u = np.mgrid[rows, columns][:, : height - rows.start, : width - columns.start]
            around = features[rows, columns]
            lengths = np.linalg.norm(around, axis=2), np.linalg.norm(features[y, x])
            off = np.linalg.norm(around - features[y, x], axis=2)
            unlike = off / (np.minimum(*lengths) + LEAST) / 0.3
            away = ((v - y) ** 2 + (u - x) ** 2) / 1.5**2
            weight = np.exp(-0.5 * (away + unlike**2))[..., None]
            found[y, x] = (weight * predictions[rows, columns]).sum(axis=(0, 1)) / weight.sum()
    return np.maximum(found, 0)


class StillWrls:
    """The pictures shown of films (H, W, 4) of one view after another; alpha: samples."""

    def __init__(self, is_delayed: bool = False) -> None:
        """Begin before the first view."""
        self._is_delayed = is_delayed
        self._model: FactoredWrls | None = None
        self._frame = 1.0  # samples

    def show(self, film: Array, end: float) -> Array:
        """The radiance shown of the next view, (H, W, 3); its pixels have equally many samples."""
        height, width, _ = film.shape
        samples = float(film[0, 0, 3])
        frames, self._frame = max(samples / self._frame, 1), samples
        light = np.asarray(film[..., :3], float)
        y = reconstructed(light, film[..., 3], np.ones((height, width)), samples)
        flat = y.reshape(-1, 3)
        if self._model is None:
            self._model = FactoredWrls(flat, self._is_delayed, frames=frames)
            predictions: Any = flat
        else:
            around = _windows(y)
            limits = around.min(axis=2).reshape(-1, 3), around.max(axis=2).reshape(-1, 3)
            predictions = self._model.add(flat, *limits, frames)
        shape = height, width, 3
        smooth = smoothed(predictions.reshape(shape), self._model.feature.reshape(shape))
        left = max(1 - samples / max(end, samples), 0)
        return np.asarray(light + left * (smooth - light))
