"""Where the probes of a scene stand: in the middles of the cells of a box.

The box is that of the scene file. Without one it holds all shapes that have bounds; and where there
are planes, which have none, most of what paths from the camera reach.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.settings import Settings

Array = NDArray[np.float64]
Counts = tuple[int, int, int]

SIDE = 5  # probes along each edge, where neither scene nor settings say
SCOUTS = 128  # paths that look for the extent of a scene
STEPS = 4  # of each
COMMON = (10, 90)  # percentiles of what they reach: as far again beyond them all of it counts
BACK = 1e-3  # of a step: how far before what it has met a path goes on
LEAST_EDGE = 1e-3  # of the longest edge of the box: flat scenes have probes over them, too


class Grid(NamedTuple):
    """A probe in the middle of each cell."""

    low: Array  # (3,): corner of the box, in the scene's coordinates
    cell: Array  # (3,): edges of a cell
    counts: Counts

    @property
    def first(self) -> Array:
        """Where the first probe stands."""
        return self.low + self.cell / 2

    @property
    def probes(self) -> int:
        """How many there are."""
        return math.prod(self.counts)

    def places(self) -> Array:
        """Where they stand, (probes, 3): x counts fastest, z slowest."""
        steps = np.stack(np.meshgrid(*map(np.arange, self.counts), indexing="ij"), axis=-1)
        return self.first + steps.transpose(2, 1, 0, 3).reshape(-1, 3) * self.cell


def grid_of(scene: Scene, settings: Settings) -> Grid:
    """The grid that settings and scene ask for."""
    given = scene.probes
    side = settings.probes or SIDE
    counts = given.counts if given and not settings.probes else (side, side, side)
    low, high = (np.array(given.min), np.array(given.max)) if given else extent_of(scene)
    return Grid(low, (high - low) / counts, counts)


def extent_of(scene: Scene) -> tuple[Array, Array]:
    """Corners of a box around what is to be lit, each (3,)."""
    boxes = [np.array(_bounds(thing)) for thing in scene.visible if not isinstance(thing, Plane)]
    has_planes = any(isinstance(thing, Plane) for thing in scene.visible)
    corners = [corner for box in boxes for corner in box]
    if has_planes and len(points := _reached(scene)):
        low, high = np.percentile(points, COMMON, axis=0)
        far = np.clip(points, 2 * low - high, 2 * high - low)
        corners += [far.min(axis=0), far.max(axis=0)]
    if not corners:
        corners = [np.array(scene.camera.position) + side for side in (-1.0, 1.0)]
    low, high = np.min(corners, axis=0), np.max(corners, axis=0)
    lacking = np.maximum(LEAST_EDGE * (high - low).max() - (high - low), 0)
    return low - lacking / 2, high + lacking / 2


def _bounds(thing: Any) -> tuple[Array, Array]:
    if isinstance(thing, Mesh):
        middle = np.array(thing.middle, np.float64)
        return middle - thing.reach, middle + thing.reach
    low, high = thing.bounds(np.array([thing.row], np.float64))
    return low[0], high[0]


def _reached(scene: Scene) -> Array:
    """What paths that scatter evenly into all directions reach from the camera, (n, 3)."""
    random = np.random.Generator(np.random.PCG64(1))
    origins = np.tile(np.array(scene.camera.position, np.float64), (SCOUTS, 1))
    directions = _towards_the_picture(scene, random)
    found = [np.zeros((0, 3))]
    for _ in range(STEPS):
        distances = _nearest(scene, origins, directions)
        meets = np.isfinite(distances)
        steps = directions[meets] * distances[meets, None]
        found.append(origins[meets] + steps)
        origins = found[-1] - BACK * steps
        directions = random.normal(size=origins.shape)
        directions /= np.linalg.norm(directions, axis=1)[:, None]
    return np.concatenate(found)


def _towards_the_picture(scene: Scene, random: np.random.Generator) -> Array:
    camera = scene.camera
    forward = np.subtract(camera.look_at, camera.position)
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    reach = math.tan(math.radians(camera.fov) / 2)
    wide = reach * scene.render.width / scene.render.height
    x, y = random.uniform(-1, 1, (2, SCOUTS, 1))
    directions = forward + wide * x * right + reach * y * np.cross(right, forward)
    return np.asarray(directions / np.linalg.norm(directions, axis=1)[:, None])


def _nearest(scene: Scene, origins: Array, directions: Array) -> Array:
    """(n,): how far rays go to the first shape but meshes, which have bounds; inf for a miss."""
    nearest = np.full(len(origins), math.inf)
    with np.errstate(all="ignore"):  # a plane beside the ray is infinitely far
        for thing in scene.visible:
            if not isinstance(thing, Mesh):
                row = np.array([thing.row], np.float64)
                nearest = np.minimum(nearest, thing.distances(row, origins, directions))
    return nearest
