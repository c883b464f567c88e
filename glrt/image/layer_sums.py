"""Weighted layers of light, summed over each of two halves of the observations.

Layers are correlated, so these two halves alone determine the error of a weighted sum: roughly,
with one degree of freedom, but without bias.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]
Floats = NDArray[np.float64]


class LayerSums(NamedTuple):
    """Mean and number of samples of every pixel, for each half of the observations."""

    means: Floats  # (2, H, W, 3)
    counts: Floats  # (2, H, W, 1): samples

    @property
    def mean(self) -> Array:
        """Mean over both halves, (H, W, 3)."""
        total = np.maximum(self.counts.sum(axis=0), 1)
        mean: Floats = (self.means * self.counts).sum(axis=0) / total
        return mean.astype(np.float32)

    @property
    def variance(self) -> Array:
        """Variance of the mean, (H, W, 3): (a - b)^2 n_a n_b / n^2; 0 where a half is missing."""
        share = self.counts / np.maximum(self.counts.sum(axis=0), 1)
        square: Floats = np.square(self.means[0] - self.means[1]) * share[0] * share[1]
        return square.astype(np.float32)

    def without(self, first: "LayerSums") -> "LayerSums":
        """The sums without the samples of `first`, which came before."""
        counts = self.counts - first.counts
        sums = self.means * self.counts - first.means * first.counts
        return LayerSums(sums / np.maximum(counts, 1), counts)
