"""Whether a coarse picture is too noisy to be read, and what is shown in its place then."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

MOST = 0.13  # grain that is read still: 1 is black to white (docs/results/design-choices.md)
SURE = 0.8  # of that: drags whose pictures all have less show the light again

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def grain_of(codes: NDArray[Any]) -> float:
    """Standard deviation of the noise of a picture, (H, W, 3 or 4) uint8, black to white as 1.

    By the mean of second differences across and down, which edges and shades hardly change:
    Immerkaer, "Fast noise variance estimation", CVIU 64 (1996). 0 for what is too small.
    """
    light = codes[..., :3] @ _LUMINANCE / 255
    down = light[:-2] - 2 * light[1:-1] + light[2:]
    both = down[:, :-2] - 2 * down[:, 1:-1] + down[:, 2:]
    return math.sqrt(math.pi / 2) / 6 * float(np.abs(both).mean()) if both.size else 0.0


class FirstSurface:
    """Whether previews are to show the first surface under simple light, and not that of paths.

    Each coarse picture of the light is judged, also while it is not shown. What a drag shows
    changes once at most, so that it does not flicker. Only drags of the camera or of an object are
    seen on first surfaces: those of bounces, say, show the light.
    """

    def __init__(self) -> None:
        """The light of the paths is shown."""
        self.is_apt = False  # for the edits that are under way
        self._is_better = self._is_refused = False
        self._worst: float | None = None  # grain of the drag

    @property
    def is_wanted(self) -> bool:
        """Whether previews are to show it."""
        return self.is_apt and self._is_better

    def judge(self, codes: NDArray[Any]) -> None:
        """Learn from a coarse picture of the light, as `grain_of` takes it."""
        self._worst = max(self._worst or 0.0, grain_of(codes))
        self._is_better |= not self._is_refused and self._worst > MOST

    def end(self) -> None:
        """The drag is over: the next one begins as this one would have."""
        if self._worst is not None and self._worst < SURE * MOST:
            self._is_better = False
        self._worst = None

    def refuse(self) -> bool:
        """The driver refused something: do without from now on; whether that may help."""
        may_help, self._is_refused = self.is_wanted, self._is_refused or self.is_wanted
        self._is_better = self._is_better and not self._is_refused
        return may_help
