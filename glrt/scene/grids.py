"""Where the grids of media lie in the world."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.text import quoted
from glrt.scene.files.named_grids import MOST_VOXELS, Voxels
from glrt.scene.schema.fields import SceneFields
from glrt.scene.shapes.base import Frame
from glrt.scene.shapes.kinds import Shape

Floats = NDArray[np.float64]


class Placement(NamedTuple):
    """The place of a grid: a point p of the world has the voxel coordinates linear @ p + origin.

    Coordinates (x, y, z) count voxels from the lowest corner of the box, so that the middle of the
    first voxel is (0.5, 0.5, 0.5).
    """

    linear: Floats  # (3, 3)
    origin: Floats  # (3,)


def placement_of(scene: SceneFields, name: str) -> Placement:
    """Return the place of the grid of a medium whose file was read."""
    density, grid = scene.media[name].density, grid_of(scene, name)
    holder = next(_holders(scene, name), None)
    frame = holder.frame if holder else Frame(np.eye(3), np.zeros(3), np.zeros(3), np.zeros(3))
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


def edge_of_voxel(scene: SceneFields, name: str) -> float:
    """Return the shortest edge of the voxels of a grid, in units of the world."""
    return float(1 / np.linalg.norm(placement_of(scene, name).linear, axis=1).max())


def steps_across(scene: SceneFields, name: str, length: float | None = None) -> int:
    """Return about how many steps a ray takes along the diagonal of a grid: bricks, collisions.

    `length`: of its steps, if it marches; 0 for the edge of a voxel.
    """
    grid, place = grid_of(scene, name), placement_of(scene, name)
    diagonal = float(np.linalg.norm(np.linalg.inv(place.linear) @ grid.voxels.shape[::-1]))
    if length is not None:
        return math.ceil(diagonal / (length or edge_of_voxel(scene, name)))
    tops = grid.top * grid.tops.astype(np.float64)
    if transfer := scene.media[name].transfer:
        bottoms = grid.top * grid.bottoms.astype(np.float64)
        depth = diagonal * float(transfer.extinction(bottoms, tops).mean())
        return (sum(tops.shape) + math.ceil(depth)) * 2 * (len(transfer.values) + 1)
    depth = max(scene.media[name].extinction) * diagonal * float(tops.mean())
    return sum(tops.shape) + math.ceil(depth)


def grid_problems(scene: SceneFields) -> Iterator[str]:
    """Yield what does not fit between media with grids and what holds them, as `key: ...`."""
    count = 0
    for name, medium in scene.media.items():
        density = medium.density
        if density is None:
            continue
        key, holders = f"media.{name}.density", list(_holders(scene, name))
        count += density.file.voxels.size if density.file.voxels is not None else 0
        if len(holders) + (scene.medium == name) > 1:
            yield (
                f"{key}: {len(holders)} objects{' and all of space' * (scene.medium == name)} hold "
                f"the medium {quoted(name)}, and a grid lies in one place. Give each a medium of "
                "its own."
            )
        is_endless = scene.medium == name or any(not it.is_bounded for it in holders)
        if is_endless and density.min is None:
            yield f"{key}.min: is missing: what holds the medium has no end. Give min and max."
        if density.min is not None or len(holders) != 1 or is_endless:
            continue
        frame = holders[0].frame
        if (frame.low >= frame.high).any():
            yield f"{key}.min: is missing: the object that holds the medium is flat. Give a box."
    if count > MOST_VOXELS:
        yield (
            f"media: their grids have {count:,} voxels together, and {MOST_VOXELS:,} are the most. "
            "Scale one down."
        )


def _holders(scene: SceneFields, name: str) -> Iterator[Shape]:
    return (it for it in scene.objects if it.medium == name and not it.hidden)
