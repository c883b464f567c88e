"""A denoised picture and its error, in channels of a file next to the plain radiance."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.denoise.denoising import Denoised

RADIANCE, ERROR = "denoised", "denoised_error"  # layers
FIGURES = ("denoised_error", "denoised_error_high")  # attributes


def to_channels(denoised: Denoised) -> dict[str, NDArray[Any]]:
    """The picture as channels of an EXR file, (H, W, 3) each, which `from_channels` reads back."""
    return {RADIANCE: denoised.radiance, ERROR: denoised.error_map}


def to_attributes(denoised: Denoised) -> dict[str, float]:
    """The error of the whole picture, as attributes for the header of the file."""
    return dict(zip(FIGURES, (denoised.error, denoised.error_high), strict=True))


def from_channels(
    header: Mapping[str, Any], channels: Mapping[str, NDArray[Any]], size: tuple[int, ...]
) -> Denoised | None:
    """Read what `to_channels` and `to_attributes` have written; None if any of it is missing."""
    errors = [header.get(name) for name in FIGURES]
    known = [error for error in errors if isinstance(error, float) and np.isfinite(error)]
    if len(known) < len(FIGURES):
        return None
    layers = []
    for layer in (RADIANCE, ERROR):
        planes = [channels.get(f"{layer}.{name}") for name in "RGB"]
        found = [plane for plane in planes if plane is not None and plane.shape == size]
        if len(found) < 3:
            return None
        layers.append(np.stack(found, axis=-1).astype(np.float32, copy=False))
    error, high = known
    return Denoised(layers[0], layers[1], error, high)
