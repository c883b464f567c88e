"""Boxes, along the axes or turned."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from glrt.scene.shapes.base import Array, Frame, Object
from glrt.scene.shapes.faces import Faces, box_faces
from glrt.scene.shapes.flat_faces import FlatFace
from glrt.scene.values import SMALLEST, Triple, Vector


class Box(Object):
    """A box, along the axes or turned about its centre; its inside can be of glass."""

    shape: Literal["box"] = Field("box", description="the kind of shape")
    min: Vector = Field(description="corner of the lowest coordinates before it is turned")
    max: Vector = Field(description="corner of the highest coordinates, each above that of min")
    rotate: Vector = Field(
        (0.0, 0.0, 0.0),
        description="angles in degrees about the x, then the y, then the z axis, through its "
        "centre",
    )

    has_inside = True
    anchor = "min"
    points = ("max",)
    extents = ()

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            min: Triple,
            max: Triple,
            rotate: Triple = (0, 0, 0),
            material: str,
            name: str | None = None,
            group: str | None = None,
            medium: str | None = None,
            hidden: bool = False,
        ) -> None: ...

    @model_validator(mode="after")
    def _has_a_volume(self) -> Self:
        for axis, low, high in zip("xyz", self.min, self.max, strict=True):
            if high - low < 2 * SMALLEST:
                raise ValueError(
                    f"max is not above min along {axis}: the box has no volume; change one of them"
                )
        return self

    @property
    def middle(self) -> Vector:
        """Centre of the box."""
        x, y, z = (np.array(self.min) + np.array(self.max)) / 2
        return (float(x), float(y), float(z))

    @property
    def halves(self) -> Array:
        """Half of the box's size along each of its axes, (3,)."""
        halves: Array = (np.array(self.max) - np.array(self.min)) / 2
        return halves

    @property
    def axes(self) -> Array:
        """Unit directions of the edges as rows, (3, 3)."""
        return rotation(self.rotate).T

    @property
    def frame(self) -> Frame:
        """The frame of `min` and `max`, turned about the middle."""
        turned, middle = self.axes.T, np.array(self.middle)
        return Frame(turned, middle - turned @ middle, middle - self.halves, middle + self.halves)

    @property
    def reach(self) -> float:
        """Half of the diagonal."""
        return float(np.linalg.norm(self.halves))

    @property
    def row(self) -> list[float]:
        """Centre, halves and axes, 15 numbers."""
        return [*self.middle, *map(float, self.halves), *map(float, self.axes.ravel())]

    def outline(self, about: Array) -> Array:
        """Return the corners of the box relative to `about`, (8, 3)."""
        corners: Array = self.polygons[:2].reshape(-1, 3) - about
        return corners

    @property
    def polygons(self) -> Array:
        """The six faces, (6, 4, 3); opposite ones follow each other."""
        edges = self.axes * self.halves[:, None]
        faces = [
            side * edges[axis] + np.array([-u - v, u - v, u + v, v - u])
            for axis in range(3)
            for u, v in [(edges[axis - 2], edges[axis - 1])]
            for side in (-1.0, 1.0)
        ]
        corners: Array = np.array(self.middle) + np.array(faces)
        return corners

    @property
    def flat_faces(self) -> Sequence[FlatFace]:
        """The six faces."""
        edges, middle = self.axes * self.halves[:, None], np.array(self.middle)
        return [
            FlatFace(middle + side * edges[k], edges[k - 2], edges[k - 1], axis, False)
            for k, axis in enumerate(self.axes)
            for side in (-1.0, 1.0)
        ]

    @property
    def faces(self) -> Faces:
        """The six faces."""
        return box_faces(np.array(self.middle), self.axes * self.halves[:, None])

    @classmethod
    def example(cls, place: Array, size: float) -> dict[str, Any]:
        """Return the fields of a cube."""
        return {"min": place - size, "max": place + size}

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Return low and high corners of boxes around the corners, (n, 3) each."""
        half = (np.abs(rows[:, 6:].reshape(-1, 3, 3)) * rows[:, 3:6, None]).sum(axis=1)
        return rows[:, :3] - half, rows[:, :3] + half

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """Return the distances to the near side, or from inside to the far side, (n,)."""
        center, halves, axes = rows[:, :3], rows[:, 3:6], rows[:, 6:].reshape(-1, 3, 3)
        start = (axes * (origin - center)[:, None]).sum(axis=2)
        along = (axes * direction[..., None, :]).sum(axis=2)
        ends = np.stack([(-halves - start) / along, (halves - start) / along])
        near = np.fmax.reduce(np.fmin(*ends), axis=1)
        far = np.fmin.reduce(np.fmax(*ends), axis=1)
        return nearest_of_two(near, np.where(near <= far, far, -math.inf))


def nearest_of_two(near: Array, far: Array) -> Array:
    """Return where rays enter, or leave from inside, (n,); inf where `far` is behind."""
    return np.where(far <= 0, math.inf, np.where(near > 0, near, far))


def rotation(degrees: Vector) -> Array:
    """Return Rz Ry Rx, (3, 3), to turn columns by angles in degrees; exact at multiples of 90."""
    (sx, cx), (sy, cy), (sz, cz) = map(sine_and_cosine, degrees)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    turn: Array = about_z @ about_y @ about_x
    return turn


def sine_and_cosine(degrees: float) -> tuple[float, float]:
    turns, rest = divmod(math.fmod(degrees, 360.0), 90.0)
    angle = math.radians(rest)
    sine, cosine = math.sin(angle), math.cos(angle)
    quarter = int(turns) % 4
    return ((sine, cosine), (cosine, -sine), (-sine, -cosine), (-cosine, sine))[quarter]
