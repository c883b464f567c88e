"""Where the grids of media lie in the world."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.files.named_grids import MOST_VOXELS, Voxels
from glrt.scene.schema.fields import SceneFields
from glrt.scene.shapes.base import Frame

Floats = NDArray[np.float64]


class Placement(NamedTuple):
    """The place of a grid: a point p of the world has the voxel coordinates linear @ p + origin.

    Coordinates (x, y, z) count voxels from the lowest corner of the box, so that the middle of the
    first voxel is (0.5, 0.5, 0.5).
    """

    linear: Floats  # (3, 3)
    origin: Floats  # (3,)


def holders_of(scene: SceneFields, name: str) -> tuple[int | None, ...]:
    """Return the numbers of the visible objects that a medium fills, and None for all of space."""
    held = [n for n, it in enumerate(scene.objects) if it.medium == name and not it.hidden]
    return (*held, None) if scene.medium == name else tuple(held)


def placement_of(scene: SceneFields, name: str, holder: int | None) -> Placement:
    """Return the place of the grid of a medium in an object, by its number, or in all of space.

    The file of the grid was read.
    """
    density, grid = scene.media[name].density, grid_of(scene, name)
    if holder is None:
        frame = Frame(np.eye(3), np.zeros(3), np.zeros(3), np.zeros(3))
    else:
        frame = scene.objects[holder].frame
    if density and density.min and density.max:
        frame = frame._replace(low=np.array(density.min), high=np.array(density.max))
    size = np.array(grid.voxels.shape[::-1]) / (frame.high - frame.low)
    inverse = np.linalg.inv(frame.axes)
    return Placement(size[:, None] * inverse, size * (-inverse @ frame.origin - frame.low))


class Grid(NamedTuple):
    """A grid that was read."""

    voxels: Voxels  # densities over `top`, (z, y, x)
    tops: Voxels  # the largest ones of each brick
    bottoms: Voxels  # the smallest ones of each brick
    top: float  # the largest density


def grid_of(scene: SceneFields, name: str) -> Grid:
    """Return the grid of a medium; ValueError before it is read."""
    density = scene.media[name].density
    file = density.file if density else None
    if density is None or file is None or file.voxels is None:
        raise ValueError(f"the grid of medium {name} was not read")
    return Grid(file.voxels, file.tops, file.bottoms, density.scale * file.most)


def edges_of_voxels(scene: SceneFields, name: str) -> tuple[float, ...]:
    """Return the shortest edge of voxels in units of the world, for each of `holders_of`."""
    places = (placement_of(scene, name, holder) for holder in holders_of(scene, name))
    return tuple(float(1 / np.linalg.norm(it.linear, axis=1).max()) for it in places)


def steps_across(scene: SceneFields, name: str, length: float | None = None) -> int:
    """Return about how many steps a ray takes through the grids of a medium, in all its objects.

    They are bricks and collisions on the diagonals. `length`: of steps, if it marches; 0 for the
    edge of a voxel.
    """
    return sum(_steps_in(scene, name, holder, length) for holder in holders_of(scene, name))


def _steps_in(scene: SceneFields, name: str, holder: int | None, length: float | None) -> int:
    grid, place = grid_of(scene, name), placement_of(scene, name, holder)
    diagonal = float(np.linalg.norm(np.linalg.inv(place.linear) @ grid.voxels.shape[::-1]))
    if length is not None:
        edge = float(1 / np.linalg.norm(place.linear, axis=1).max())
        return math.ceil(diagonal / (length or edge))
    tops = grid.top * grid.tops.astype(np.float64)
    if transfer := scene.media[name].transfer:
        bottoms = grid.top * grid.bottoms.astype(np.float64)
        depth = diagonal * float(transfer.extinction(bottoms, tops).mean())
        return (sum(tops.shape) + math.ceil(depth)) * 2 * (len(transfer.values) + 1)
    depth = max(scene.media[name].extinction) * diagonal * float(tops.mean())
    return sum(tops.shape) + math.ceil(depth)


def grid_problems(scene: SceneFields) -> Iterator[str]:
    """Yield what does not fit between media with grids and what holds them, as `key: ...`."""
    voxels: dict[str | None, int] = {}
    for name, medium in scene.media.items():
        density = medium.density
        if density is None:
            continue
        if density.file.voxels is not None:
            voxels[density.file.sha256] = density.file.voxels.size
        if density.min is None:
            yield from _boxless(scene, name)
    count = sum(voxels.values())
    if count > MOST_VOXELS:
        yield (
            f"media: their grids have {count:,} voxels together, and {MOST_VOXELS:,} are the most. "
            "Scale one down."
        )


def _boxless(scene: SceneFields, name: str) -> Iterator[str]:
    """Yield why a grid without `min` and `max` has no box in some object that it fills."""
    key = f"media.{name}.density.min: is missing:"
    numbers = holders_of(scene, name)
    holders = [scene.objects[number] for number in numbers if number is not None]
    if None in numbers or not all(it.is_bounded for it in holders):
        yield f"{key} what holds the medium has no end. Give min and max."
    elif any((it.frame.low >= it.frame.high).any() for it in holders):
        yield f"{key} an object that holds the medium is flat. Give a box."
