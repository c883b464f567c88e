"""Positions of the probes of a scene: the middles of the cells of a box.

The scene file may give the box. Otherwise it holds all shapes that have bounds and, in scenes with
planes, most points that paths from the camera reach.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.settings import Settings

Array = NDArray[np.float64]
Counts = tuple[int, int, int]

SIDE = 5  # probes along each edge, unless scene or settings give a number
SCOUTS = 128  # paths that look for the extent of a scene
STEPS = 4  # surfaces that each of these paths meets at most
COMMON = (10, 90)  # percentiles of the points reached; the box ends at most one such range beyond
BACK = 1e-3  # share of a step: a path goes on so far before the surface that it met
ROUNDING = 1e-9  # of a share times a number of probes
LEAST_EDGE = 1e-3  # share of the longest edge of the box: flat scenes have probes above them, too


class Grid(NamedTuple):
    """A box of cells, with a probe in the middle of each."""

    low: Array  # (3,): corner of the box, in the scene's coordinates
    cell: Array  # (3,): edges of a cell
    counts: Counts

    @property
    def first(self) -> Array:
        """Position of the first probe, (3,)."""
        return self.low + self.cell / 2

    @property
    def probes(self) -> int:
        """Number of probes."""
        return math.prod(self.counts)

    def places(self) -> Array:
        """Return the positions of the probes, (probes, 3): x varies fastest, z slowest."""
        steps = np.stack(np.meshgrid(*map(np.arange, self.counts), indexing="ij"), axis=-1)
        return self.first + steps.transpose(2, 1, 0, 3).reshape(-1, 3) * self.cell


def grid_of(scene: Scene, settings: Settings) -> Grid:
    """Return the grid of probes for a scene and its settings."""
    given = scene.probes
    side = settings.probes or SIDE
    counts = given.counts if given and not settings.probes else (side, side, side)
    box = given.box if given else None
    low, high = (np.array(box[0]), np.array(box[1])) if box else extent_of(scene)
    return Grid(low, (high - low) / counts, counts)


def updated_at_once(scene: Scene, probes: int) -> int:
    """Return how many of so many live probes one picture updates: the share, rounded up."""
    share = scene.probes.per_update if scene.probes else 1.0
    return min(math.ceil(share * probes - ROUNDING), probes)


def extent_of(scene: Scene) -> tuple[Array, Array]:
    """Return the low and high corner of a box around what is to be lit, (3,) each."""
    boxes = [np.array(_bounds(thing)) for thing in scene.visible if thing.is_bounded]
    has_planes = any(not thing.is_bounded for thing in scene.visible)
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
    """Return points that paths from the camera reach if they scatter evenly, (n, 3)."""
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
    """Return the distances of rays to the first shape other than a mesh, (n,); inf for a miss."""
    nearest = np.full(len(origins), math.inf)
    with np.errstate(all="ignore"):  # a plane parallel to the ray is infinitely far
        for thing in scene.visible:
            if not isinstance(thing, Mesh):
                row = np.array([thing.row], np.float64)
                nearest = np.minimum(nearest, thing.distances(row, origins, directions))
    return nearest
