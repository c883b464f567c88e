"""Half of the samples of a picture, with what guides a filter."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.float32]


class Guide(NamedTuple):
    """What is known of the first surface behind each pixel, (H, W, 3) each."""

    mean: Pixels
    variance: Pixels  # of that mean


class Half(NamedTuple):
    """Means over some samples of a picture; those of the two halves are independent."""

    radiance: Pixels  # (H, W, 3)
    variance: Pixels  # of that mean, (H, W, 3); an estimate without bias
    share: float  # of the samples of the picture, 0 to 1; the two make 1
    albedo: Guide
    normal: Guide

    @property
    def guides(self) -> tuple[Guide, Guide]:
        """Both guides."""
        return self.albedo, self.normal
