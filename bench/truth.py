"""The truth of a scene: two renders by other seeds than those of the pictures that are judged.

The mean of (x - r1) (x - r2) is the squared error of a picture x, without the noise of r1 and r2.
"""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.error.estimate import DARK
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer

TRUTH_SEED = 1000  # of the first of two; pictures take seeds from 0

Floats = NDArray[np.float64]


class Truth(NamedTuple):
    """Two independent renders, (H, W, 3) each."""

    first: Floats
    second: Floats

    def squares(self, radiance: NDArray[np.float32]) -> Floats:
        """Squared errors of a picture, (H, W, 3): right on average, negative at times."""
        picture = radiance.astype(np.float64)
        return (picture - self.first) * (picture - self.second)

    def relative(self, radiance: NDArray[np.float32]) -> float:
        """Squared relative error of a picture."""
        return self.shared(radiance, radiance)

    def shared(self, one: NDArray[np.float32], other: NDArray[np.float32]) -> float:
        """The square of the relative error that two pictures share, without the noise of either."""
        errors = (one.astype(np.float64) - self.first) * (other.astype(np.float64) - self.second)
        return float((errors / (self.mean**2 + DARK * self.mean.mean() ** 2)).mean())

    @property
    def mean(self) -> Floats:
        """The mean of both renders."""
        return (self.first + self.second) / 2


def truth_of(
    name: str, context: Context, folder: Path | None, size: int, samples: int, **settings: Any
) -> Truth:
    """Two renders of half of the samples each; from the folder where they were made before."""
    told = [name.replace("/", "-"), size, samples, *(f"{k}-{v}" for k, v in settings.items())]
    kept = folder / f"{'-'.join(map(str, told))}.npz" if folder else None
    if kept and kept.is_file():
        with np.load(kept) as file:
            return Truth(*(file[key].astype(np.float64) for key in ("first", "second")))
    wanted: dict[str, Any] = {"width": size, "height": size, "samples": samples // 2, **settings}
    halves = []
    for seed in (TRUTH_SEED, TRUTH_SEED + 1):
        renderer = Renderer(load(name), None, context, "complete", seed=seed, **wanted)
        halves.append(renderer.render().image().radiance)
        renderer.release()
    if kept:
        kept.parent.mkdir(parents=True, exist_ok=True)
        np.savez(kept, first=halves[0], second=halves[1])
    return Truth(*(half.astype(np.float64) for half in halves))
