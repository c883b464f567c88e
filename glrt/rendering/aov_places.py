"""Read AOVs back from where films hold them."""

from typing import Any, NamedTuple

import numpy as np

from glrt.image.aovs import AovImage
from glrt.packing.shapes import order_of_kernel
from glrt.rendering.pass_film import Array, PassFilm
from glrt.scene.scene import Scene
from glrt.settings import Aov


class Place(NamedTuple):
    """Where a film holds an AOV."""

    film: PassFilm
    prefix: str  # of the names of its outputs
    part: int
    parts: int  # side by side in an output

    def rows(self, name: str, first: int, end: int) -> Array:
        """Rows of an output, (rows, width, 4)."""
        rows = self.film.read_output(f"{self.prefix}{name}", first, end)
        width = rows.shape[1] // self.parts
        return rows[:, self.part * width : (self.part + 1) * width]


def image_of(aov: Aov, place: Place, scene: Scene) -> AovImage:
    """Read one AOV back, with object numbers and positions converted to the scene's."""
    height = place.film.sources["mean"].height
    mean, variance = (place.rows(name, 0, height) for name in ("mean", "variance"))
    if aov == "object":
        numbers = np.array([0, *(1 + index for index in order_of_kernel(scene))], np.uint32)
        return AovImage(numbers[mean[..., 0].astype(np.int64)])
    count, observations = mean[..., 3], variance[..., 3]
    value, stderr = mean[..., :3], standard_error(variance)
    is_met = count[..., None] > 0
    if aov == "position":
        eye = np.array(scene.camera.position, np.float64)
        value = np.where(is_met, value + eye, 0.0).astype(np.float32)
    if aov == "depth":
        value = np.where(is_met, value, np.float32(np.inf))
    if aov in ("depth", "bounces"):
        value, stderr = value[..., 0], stderr[..., 0]
    counts = (part.astype(np.uint32) for part in (count, observations))
    return AovImage(np.ascontiguousarray(value), np.ascontiguousarray(stderr), *counts)


def standard_error(variance: Array) -> Any:
    """Standard error of each mean; channel 3 of `variance` counts observations, NaN below two."""
    count = variance[..., 3:]
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.sqrt(variance[..., :3] / (count - 1))
    return np.where(count >= 2, error, np.float32(np.nan)).astype(np.float32)
