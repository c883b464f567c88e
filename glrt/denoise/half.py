"""Half of the samples of a picture, with the guides of a filter."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.float32]


class Guide(NamedTuple):
    """An AOV of the first surface behind each pixel: mean and variance, (H, W, 3) each."""

    mean: Pixels
    variance: Pixels  # variance of that mean


class Half(NamedTuple):
    """Means over half of the samples of a picture; the two halves are independent."""

    radiance: Pixels  # (H, W, 3)
    variance: Pixels  # variance of that mean, (H, W, 3); an estimate without bias
    share: float  # of the picture's samples, 0 to 1; both shares add to 1
    albedo: Guide
    normal: Guide

    @property
    def guides(self) -> tuple[Guide, Guide]:
        """The two guides, albedo and normal."""
        return self.albedo, self.normal
