"""Kernel data for probes: their grid as fields of the frame, and the block of an update."""

from itertools import count
from math import gcd
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.gpu.glsl import expanded
from glrt.gpu.structs import read_constants, read_structs, record
from glrt.plan.probe_grid import Grid
from glrt.scene.camera import Camera

Array = NDArray[np.float64]

_TEXT = expanded("structs/probes.glsl")
_UPDATE = read_structs(_TEXT)["ProbeUpdate"]
_CONSTANTS = read_constants(_TEXT)
MOST_RAYS = _CONSTANTS["MOST_PROBE_RAYS"]
LIGHT, DISTANCES, PUSHES, USE = (
    _CONSTANTS[f"FOR_{name}"] for name in ("LIGHT", "DISTANCES", "PUSHES", "USE")
)
_GRID = read_constants(expanded("probes/grid.glsl"))
LIGHT_MAP, DISTANCE_MAP = _GRID["LIGHT_SIDE"] + 2, _GRID["DISTANCE_SIDE"] + 2  # texels along edges
IN_ROW = _GRID["PROBES_IN_ROW"]

_TURN = (5**0.5 - 1) / 2  # share of a circle from one point of a spiral to the next
_OFF = ("probe_first", "probe_edge", "probe_cell", "probe_count", "probe_counts")


def probe_fields(grid: Grid | None, camera: Camera) -> dict[str, object]:
    """Return the frame fields that describe the grid, relative to the camera; 0 without a grid."""
    if grid is None:
        return dict.fromkeys(_OFF, 0)
    return {
        "probe_first": grid.first - np.array(camera.position, np.float64),
        "probe_edge": grid.cell.min(),
        "probe_cell": grid.cell,
        "probe_count": grid.probes,
        "probe_counts": grid.counts,
    }


def even_directions(count: int) -> Array:
    """Return unit vectors evenly spread over the sphere, (count, 3): a spherical Fibonacci lattice.

    Keinert et al., "Spherical Fibonacci Mapping", 2015.
    """
    n = np.arange(count)
    z = 1 - (2 * n + 1) / count
    around, flat = 2 * np.pi * ((n * _TURN) % 1), np.sqrt(1 - z * z)
    return np.stack([flat * np.cos(around), flat * np.sin(around), z], axis=1)


def turn(numbers: NDArray[np.uint32]) -> Array:
    """Return a rotation, (3, 3), uniform over all rotations if the first three numbers are uniform.

    Shoemake, "Uniform Random Rotations", Graphics Gems III, 1992.
    """
    u, v, w = numbers[:3] / 2.0**32
    inner, outer = np.sqrt(1 - u), np.sqrt(u)
    x, y = inner * np.sin(2 * np.pi * v), inner * np.cos(2 * np.pi * v)
    z, s = outer * np.sin(2 * np.pi * w), outer * np.cos(2 * np.pi * w)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * s), 2 * (x * z + y * s)],
            [2 * (x * y + z * s), 1 - 2 * (x * x + z * z), 2 * (y * z - x * s)],
            [2 * (x * z - y * s), 2 * (y * z + x * s), 1 - 2 * (x * x + y * y)],
        ]
    )


def seeds(*numbers: int) -> NDArray[np.uint32]:
    """Return four random numbers that depend on these numbers alone."""
    return np.asarray(np.random.SeedSequence(numbers).generate_state(4), np.uint32)


class Turn(NamedTuple):
    """The probes of one update: a run of an order of all probes, which goes on at its beginning."""

    probes: int  # in the grid
    first: int  # place in the order
    length: int

    @property
    def stride(self) -> int:
        """Step from probe to probe in the order, near the golden ratio: it spreads over the grid.

        It has no factor in common with the number of probes, so that each stands once in the order.
        """
        near = max(round(_TURN * self.probes), 1)
        return next(n for n in count(near) if gcd(n, self.probes) == 1)

    @property
    def numbers(self) -> NDArray[np.int64]:
        """The numbers of the probes, (length,)."""
        return (self.first + np.arange(self.length)) * self.stride % self.probes

    @property
    def next(self) -> int:
        """The place in the order where the next update begins."""
        return (self.first + self.length) % self.probes


def all_of(probes: int) -> Turn:
    """Return an update of all probes."""
    return Turn(probes, 0, probes)


def update_block(
    directions: Array,
    purpose: int,
    probes: Turn,
    number: int = 0,
    seed: int = 0,
    kept: float = 0.0,
) -> bytes:
    """Return the bytes of the block of an update by rays into these directions, (n, 3)."""
    fields: dict[str, object] = {"rays": len(directions), "number": number, "seed": seed}
    fields |= {"first": probes.first, "count": probes.length, "stride": probes.stride}
    rows = np.zeros((MOST_RAYS, 4), np.float32)
    rows[: len(directions), :3] = directions
    update = record(_UPDATE, {**fields, "purpose": purpose, "kept": kept})
    return update.tobytes() + rows.tobytes()
