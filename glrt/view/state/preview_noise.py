"""Judge whether previews are too noisy to recognise anything, and need a replacement."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

MOST = 0.13  # legible grain, at most: 1 is black to white (docs/results/design-choices.md)
SURE = 0.8  # of that: after a drag with less in all pictures, the light is shown again

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def grain_of(codes: NDArray[Any]) -> float:
    """Return the standard deviation of the noise of codes (H, W, 3 or 4) uint8; white is 1.

    It is estimated by the mean of second differences across and down, which edges and shades
    hardly change: Immerkaer, "Fast noise variance estimation", CVIU 64 (1996). 0 if too small.
    """
    light = codes[..., :3] @ _LUMINANCE / 255
    down = light[:-2] - 2 * light[1:-1] + light[2:]
    both = down[:, :-2] - 2 * down[:, 1:-1] + down[:, 2:]
    return math.sqrt(math.pi / 2) / 6 * float(np.abs(both).mean()) if both.size else 0.0


class FirstSurface:
    """Whether previews show the first surface under simple light instead of the light of paths.

    Each preview of the light is judged, also while it is not shown. A drag changes between the two
    at most once, so that it does not flicker. Only drags of the camera or of an object may show
    first surfaces: those of bounces, for example, show the light.
    """

    def __init__(self) -> None:
        """Begin with the light of the paths."""
        self.is_apt = False  # whether the present edits may show first surfaces
        self._is_better = self._is_refused = False
        self._worst: float | None = None  # grain of the drag

    @property
    def is_wanted(self) -> bool:
        """Whether previews are to show the first surface."""
        return self.is_apt and self._is_better

    def judge(self, codes: NDArray[Any]) -> None:
        """Learn from a preview of the light, in the format of `grain_of`."""
        self._worst = max(self._worst or 0.0, grain_of(codes))
        self._is_better |= not self._is_refused and self._worst > MOST

    def end(self) -> None:
        """End the drag; if all its previews had little noise, the next one shows the light."""
        if self._worst is not None and self._worst < SURE * MOST:
            self._is_better = False
        self._worst = None

    def refuse(self) -> bool:
        """Use no first surfaces after a refusal of the driver; returns whether that may help."""
        may_help, self._is_refused = self.is_wanted, self._is_refused or self.is_wanted
        self._is_better = self._is_better and not self._is_refused
        return may_help
