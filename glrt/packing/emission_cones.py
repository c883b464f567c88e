"""Cones around the directions in which lamps emit.

A lamp that has a cone, or that emits from one side alone, is not chosen at points that it does not
light.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from glrt.scene.lights.cone import Cone
from glrt.scene.materials.base import Opaque
from glrt.scene.scene import Scene
from glrt.scene.shapes.base import Object

Array = np.ndarray[Any, Any]

STEEPEST = 1e30  # slope of an edge without a width


class Aims(NamedTuple):
    """Emission cones of n lamps or groups of lamps, as in the structs Emitter and Aim."""

    axis: Array  # (n, 3), unit; 0 where light goes everywhere
    outer: Array  # (n,): 1 - cos of the half angle beyond which nothing is emitted
    slope: Array  # (n,): 1 over the width of the edge in 1 - cos

    def of(self, members: Any) -> "Aims":
        """Return the cones of some of the lamps."""
        return Aims(*(column[members] for column in self))


def everywhere(count: int) -> Aims:
    """Return cones for `count` lamps that emit in all directions: `outer` is above any 1 - cos."""
    return Aims(np.zeros((count, 3)), np.full(count, 4.0), np.ones(count))


def cone_fields(cone: Cone) -> tuple[float, float]:
    """Return the fields outer and slope of the structs Emitter and Aim."""
    inner, outer = cone.versines
    return outer, min(1 / (outer - inner), STEEPEST) if outer > inner else STEEPEST


def aims_of(scene: Scene, lamps: Sequence[Object], normals: Array) -> Aims:
    """Return the emission cones of lamps with these normals, (n, 3) of any length."""
    found = everywhere(len(lamps))
    lengths = np.linalg.norm(normals, axis=1)
    units = normals / np.where(lengths > 0, lengths, 1)[:, None]
    for number, lamp in enumerate(lamps):
        material = scene.materials[lamp.material]
        if isinstance(material, Opaque) and material.cone:
            found.axis[number] = material.cone.unit_axis
            found.outer[number], found.slope[number] = cone_fields(material.cone)
        elif lamp.is_one_sided:
            found.axis[number] = units[number]
            found.outer[number], found.slope[number] = 1.0, STEEPEST
    return found


def around_all(aims: Aims) -> Aims:
    """Return one cone that holds all given ones: their own if they are equal, else a wider one."""
    if all((column == column[0]).all() for column in aims):
        return aims.of(slice(0, 1))
    axis = aims.axis.mean(axis=0)
    if not axis.any() or not aims.axis.any(axis=1).all():
        return everywhere(1)
    axis /= np.linalg.norm(axis)
    apart = np.arccos(np.clip(aims.axis @ axis, -1, 1))
    reach = float((apart + np.arccos(np.clip(1 - aims.outer, -1, 1))).max()) + _MARGIN
    if reach >= math.pi:
        return everywhere(1)
    return Aims(axis[None], np.array([1 - math.cos(reach)]), np.array([STEEPEST]))


_MARGIN = 1e-6  # radians, for the rounding of an arc cosine near 1
