"""Where the grids of media lie in the world."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.text import quoted
from glrt.scene.density import Density
from glrt.scene.files.named_grids import MOST_VOXELS, Voxels
from glrt.scene.schema.fields import SceneFields
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.kinds import KINDS, Shape
from glrt.scene.shapes.mesh import Mesh

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
    holder = next((it for it in _holders(scene, name)), None)
    linear, origin = _frame(holder)
    low, high = _box(density, holder)
    size = np.array(grid.voxels.shape[::-1]) / (high - low)
    inverse = np.linalg.inv(linear)
    return Placement(size[:, None] * inverse, size * (-inverse @ origin - low))


class Grid(NamedTuple):
    """A grid that was read."""

    voxels: Voxels  # densities over `top`, (z, y, x)
    tops: Voxels  # the largest ones of each brick
    top: float  # the largest density


def grid_of(scene: SceneFields, name: str) -> Grid:
    """Return the grid of a medium; ValueError before it is read."""
    density = scene.media[name].density
    if density is None or density.file.voxels is None:
        raise ValueError(f"the grid of medium {name} was not read")
    return Grid(density.file.voxels, density.file.tops, density.scale * density.file.most)


def steps_across(scene: SceneFields, name: str) -> int:
    """Return about how many steps a ray takes along the diagonal of a grid: bricks, collisions."""
    grid, place = grid_of(scene, name), placement_of(scene, name)
    diagonal = float(np.linalg.norm(np.linalg.inv(place.linear) @ grid.voxels.shape[::-1]))
    depth = max(scene.media[name].extinction) * grid.top * diagonal
    return sum(grid.tops.shape) + math.ceil(depth * float(grid.tops.mean(dtype=np.float64)))


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
        low, high = _bounds(holders[0])
        if (low >= high).any():
            yield f"{key}.min: is missing: the object that holds the medium is flat. Give a box."
    if count > MOST_VOXELS:
        yield (
            f"media: their grids have {count:,} voxels together, and {MOST_VOXELS:,} are the most. "
            "Scale one down."
        )


def _holders(scene: SceneFields, name: str) -> Iterator[Shape]:
    return (it for it in scene.objects if it.medium == name and not it.hidden)


def _box(density: Density | None, holder: Shape | None) -> tuple[Floats, Floats]:
    """Return the corners of the box of a grid, in the frame of its object."""
    if density is not None and density.min is not None and density.max is not None:
        return np.array(density.min), np.array(density.max)
    assert holder is not None
    return _bounds(holder)


def _frame(holder: Shape | None) -> tuple[Floats, Floats]:
    """Return the frame of an object: a point q in it is linear @ q + origin in the world."""
    if isinstance(holder, Mesh):
        return holder.linear, holder.origin
    if isinstance(holder, Box):
        turned, middle = holder.axes.T, np.array(holder.middle)
        return turned, middle - turned @ middle
    return np.eye(3), np.zeros(3)


def _bounds(holder: Shape) -> tuple[Floats, Floats]:
    """Return the corners of the box around an object, in its frame."""
    if isinstance(holder, Mesh):
        vertices = holder.triangles.vertices
        return vertices.min(axis=0), vertices.max(axis=0)
    if isinstance(holder, Box):
        middle, halves = np.array(holder.middle), holder.halves
        return middle - halves, middle + halves
    low, high = KINDS[holder.shape].bounds(np.array([holder.row], np.float64))
    return low[0], high[0]
