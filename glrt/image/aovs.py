"""AOVs (arbitrary output variables) of a picture: of first surfaces, of paths, and terms of light.

A sample that meets nothing counts with albedo and normal 0, but not for depth and position. Where
no sample meets anything, depth is infinite and position 0. `bounces` is how often the paths scatter
before they end. Terms are parts of the radiance.

In an EXR file an AOV is a layer of its name; its standard error and its counts have channels of
their own.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from glrt.settings import TERMS, Aov

CHANNELS: dict[Aov, str] = {
    "albedo": "RGB",
    "normal": "XYZ",
    "depth": "Z",
    "position": "XYZ",
    "object": "I",
    "bounces": "N",
    **dict.fromkeys(TERMS, "RGB"),
}

if list(CHANNELS) != list(get_args(Aov)):
    raise TypeError(f"AOVs {get_args(Aov)} have channels {CHANNELS}")


@dataclass(frozen=True, eq=False)
class AovImage:
    """One AOV of a picture, row 0 on top."""

    value: NDArray[Any]  # (H, W, 3) float32; depth, bounces (H, W); object (H, W) uint32
    stderr: NDArray[np.float32] | None = None  # standard error, of the same shape; None for object
    count: NDArray[np.uint32] | None = None  # (H, W): samples in the mean
    observations: NDArray[np.uint32] | None = None  # (H, W): complete ones, as of the radiance


AovImages = Mapping[Aov, AovImage]


def to_channels(aovs: AovImages) -> dict[str, NDArray[Any]]:
    """The AOVs as channels of an EXR file, (H, W) each, which `from_channels` reads back."""
    channels: dict[str, NDArray[Any]] = {}
    for name, aov in aovs.items():
        channels |= _planes(name, CHANNELS[name], aov.value)
        if aov.stderr is not None:
            channels |= _planes(f"stderr.{name}", CHANNELS[name], aov.stderr)
        counts = {"count": aov.count, "observations": aov.observations}
        channels |= {f"film.{name}.{k}": v for k, v in counts.items() if v is not None}
    return channels


def from_channels(channels: Mapping[str, NDArray[Any]], aovs: tuple[Aov, ...]) -> AovImages:
    """The AOVs among channels, (H, W) each; incomplete AOVs are left out."""
    found = {}
    for name in aovs:
        value = _stacked(channels, name, CHANNELS[name])
        stderr = _stacked(channels, f"stderr.{name}", CHANNELS[name])
        counts = [channels.get(f"film.{name}.{what}") for what in ("count", "observations")]
        rest = [stderr, *counts]
        if value is not None and (name == "object" or all(part is not None for part in rest)):
            found[name] = AovImage(value, *rest)
    return found


def _planes(layer: str, names: str, pixels: NDArray[Any]) -> dict[str, NDArray[Any]]:
    planes = pixels[..., None] if pixels.ndim == 2 else pixels
    return {f"{layer}.{name}": planes[..., i] for i, name in enumerate(names)}


def _stacked(channels: Mapping[str, NDArray[Any]], layer: str, names: str) -> NDArray[Any] | None:
    planes = [channels.get(f"{layer}.{name}") for name in names]
    if any(plane is None for plane in planes):
        return None
    stacked = np.stack([plane for plane in planes if plane is not None], axis=-1)
    return stacked[..., 0] if len(names) == 1 else stacked
