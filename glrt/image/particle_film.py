"""A picture as the sum of two films: of paths from the camera, and of particles from lamps.

In a file each film is a layer of its own, `camera` and `particles`, next to their sum. The standard
error is that of the sum: the films are independent, so their variances add.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.image.film_state import error_of_mean

Array = NDArray[np.float32]

CAMERA, MEAN, VARIANCE = "camera", "particles", "film.particles"


class ParticleFilm(NamedTuple):
    """The two films of a picture with particles; arrays (H, W, 3) float32.

    Every pixel has the same number of observations of particles: that of the picture, and one more
    if the picture ends inside an observation.
    """

    camera: Array  # radiance of the paths from the camera
    mean: Array  # radiance of the particles
    variance: Array  # variance of one observation of particles


def observations_of(samples: int, block: int) -> int:
    """Number of observations of particles for `samples` a pixel, `block` in each observation."""
    return -(-samples // block)


def summed(film: ParticleFilm, stderr: Array, observations: int) -> tuple[Array, Array]:
    """The picture and its standard error, (H, W, 3) each; `stderr` is that of the camera's film."""
    counts = np.full(stderr.shape[:2], observations, np.float32)
    none = np.zeros_like(film.mean), np.zeros_like(counts)
    own = error_of_mean(film.mean, film.variance, counts, *none)
    return film.camera + film.mean, np.hypot(stderr, own)


def to_channels(film: ParticleFilm) -> dict[str, NDArray[Any]]:
    """The films as channels of an EXR file, (H, W, 3) each, which `from_channels` reads back."""
    return dict(zip((CAMERA, MEAN, VARIANCE), film, strict=True))


def from_channels(
    channels: Mapping[str, NDArray[Any]], size: tuple[int, ...]
) -> ParticleFilm | None:
    """Read what `to_channels` wrote; None if a plane, (H, W), is missing or of another size."""
    layers = []
    for layer in (CAMERA, MEAN, VARIANCE):
        planes = [channels.get(f"{layer}.{name}") for name in "RGB"]
        found = [plane for plane in planes if plane is not None and plane.shape == size]
        if len(found) < 3:
            return None
        layers.append(np.stack(found, axis=-1).astype(np.float32, copy=False))
    return ParticleFilm(*layers)
