"""Cylinders, open at their ends or closed."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np
from pydantic import Field, create_model, model_validator

from glrt.scene.shapes.base import NO_POLYGONS, UP, Array, Object, about_axis, dots, ring
from glrt.scene.shapes.box import nearest_of_two
from glrt.scene.shapes.faces import STEPS, Faces, circle, faces_of_triangles
from glrt.scene.shapes.flat_faces import FlatFace
from glrt.scene.values import SMALLEST, Length, Number, Triple, Vector

if TYPE_CHECKING:
    _Ended = Object
else:  # a field whose name is a keyword of Python
    _Ended = create_model(
        "_Ended",
        __base__=Object,
        shape=(str, "cylinder"),
        **{"from": (Vector, Field(description="middle of one end, x y z in scene units"))},
    )


class Cylinder(_Ended):
    """A round wall between two ends; with caps, its inside can be of glass.

    Python code gives `from_`, since `from` is a keyword of the language.
    """

    shape: Literal["cylinder"] = Field("cylinder", description="the kind of shape")
    to: Vector = Field(description="middle of the other end, x y z in scene units")
    radius: Length = Field(description="radius in scene units")
    capped: bool = Field(True, description="whether a disk closes each end")

    has_inside = True
    anchor = "from"
    points = ("to",)
    extents = ("radius",)

    if TYPE_CHECKING:

        def __init__(
            self,
            *,
            from_: Triple,
            to: Triple,
            radius: Number,
            capped: bool = True,
            material: str,
            name: str | None = None,
            group: str | None = None,
            medium: str | None = None,
            hidden: bool = False,
        ) -> None: ...

    @model_validator(mode="before")
    @classmethod
    def _takes_from_python(cls, data: Any) -> Any:
        if isinstance(data, dict) and "from_" in data and "from" not in data:
            return {"from" if key == "from_" else key: value for key, value in data.items()}
        return data

    @model_validator(mode="after")
    def _has_a_height(self) -> Self:
        if 2 * self.half < 2 * SMALLEST:
            raise ValueError(
                "from and to are the same point: the cylinder has no height; move one of them"
            )
        return self

    @property
    def from_(self) -> Vector:
        """Middle of one end."""
        start: Vector = getattr(self, "from")
        return start

    @property
    def encloses(self) -> bool:
        """Whether the cylinder has caps."""
        return self.capped

    @property
    def middle(self) -> Vector:
        """The point halfway between the ends."""
        x, y, z = (np.array(self.from_) + np.array(self.to)) / 2
        return (float(x), float(y), float(z))

    @property
    def half(self) -> float:
        """Half of the height."""
        return math.dist(self.from_, self.to) / 2

    @property
    def axis(self) -> Array:
        """Unit vector from one end to the other, (3,)."""
        along = np.subtract(self.to, self.from_)
        unit: Array = along / np.linalg.norm(along)
        return unit

    @property
    def reach(self) -> float:
        """Distance from the middle to a rim."""
        return math.hypot(self.half, self.radius)

    @property
    def row(self) -> list[float]:
        """Middle, axis, half of the height, radius, and 1 with caps: 9 numbers."""
        axis = map(float, self.axis)
        return [*self.middle, *axis, self.half, self.radius, float(self.capped)]

    @property
    def placement(self) -> Array:
        """Axes and origin, (3, 4): radius and half of the height are 1 there."""
        return about_axis(self.axis, self.middle, self.radius, self.half)

    def outline(self, about: Array) -> Array:
        """Return ends relative to `about`, radius and caps, (2, 5)."""
        ends = np.array([self.from_, self.to]) - about
        return np.column_stack([ends, np.full((2, 2), [self.radius, self.capped])])

    @property
    def polygons(self) -> Array:
        """The caps as polygons, (2, k, 3); none for an open cylinder."""
        if not self.capped:
            return NO_POLYGONS
        return np.array(
            [ring(np.array(end), self.axis, self.radius) for end in (self.from_, self.to)]
        )

    @property
    def flat_faces(self) -> Sequence[FlatFace]:
        """The caps; none for an open cylinder."""
        if not self.capped:
            return ()
        across = np.cross(self.axis, np.eye(3)[np.abs(self.axis).argmin()])
        u = self.radius * across / np.linalg.norm(across)
        v = np.cross(self.axis, u)
        ends = np.array(self.from_), np.array(self.to)
        return [FlatFace(end, u, v, self.axis, True) for end in ends]

    @property
    def faces(self) -> Faces:
        """The wall in strips, and the caps."""
        low, high = np.array(self.from_), np.array(self.to)
        axis = (high - low) / np.linalg.norm(high - low)
        below = circle(low, axis, self.radius)[:, 0]
        vertices = np.concatenate([below, below + (high - low), [low, high]])
        k = np.arange(STEPS)
        n = (k + 1) % STEPS
        wall = np.concatenate(
            [np.stack([k, n, n + STEPS], 1), np.stack([k, n + STEPS, k + STEPS], 1)]
        )
        caps = np.concatenate(
            [
                np.stack([n, k, np.full(STEPS, 2 * STEPS)], 1),
                np.stack([k + STEPS, n + STEPS, np.full(STEPS, 2 * STEPS + 1)], 1),
            ]
        )
        triangles = np.concatenate([wall, caps]) if self.capped else wall
        flat = np.concatenate([np.tile(k, 2), np.repeat([STEPS, STEPS + 1], STEPS)])
        return faces_of_triangles(vertices, triangles, flat[: len(triangles)])

    @classmethod
    def example(cls, place: Array, size: float) -> dict[str, Any]:
        """Return the fields of an upright cylinder, twice as high as wide."""
        return {"from": place - size * UP, "to": place + size * UP, "radius": size / 2}

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Return low and high corners of boxes around both rims, (n, 3) each."""
        axis, half, radius = rows[:, 3:6], rows[:, 6:7], rows[:, 7:8]
        reach = half * np.abs(axis) + radius * np.sqrt(np.maximum(1 - axis**2, 0))
        return rows[:, :3] - reach, rows[:, :3] + reach

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """Return distances to the near side; to the far side from inside or through open ends."""
        axis, half = rows[:, 3:6], rows[:, 6]
        start, heading = ((origin - rows[:, :3]) * axis).sum(axis=1), dots(axis, direction)
        near, far = _to_walls(rows, origin, direction)
        ends = np.stack([(-half - start) / heading, (half - start) / heading])
        first, last = np.maximum(near, np.fmin(*ends)), np.minimum(far, np.fmax(*ends))
        closed = nearest_of_two(first, np.where(first <= last, last, -math.inf))
        walls = np.stack([near, far])
        on = (walls > 0) & (np.abs(start + walls * heading) <= half)
        return np.where(rows[:, 8] > 0, closed, np.where(on, walls, math.inf).min(axis=0))


def _to_walls(rows: Array, origin: Array, direction: Array) -> tuple[Array, Array]:
    """Return where rays enter and leave walls without ends, (n,) each; NaN for a miss."""
    axis, radius = rows[:, 3:6], rows[:, 7]
    offset = origin - rows[:, :3]
    beside = offset - (offset * axis).sum(axis=1)[:, None] * axis
    across = direction - dots(axis, direction)[:, None] * axis
    square = (across * across).sum(axis=1)
    middle = -(beside * across).sum(axis=1) / square
    closest = beside + middle[:, None] * across
    rest = np.sqrt((radius**2 - (closest * closest).sum(axis=1)) / square)
    inside = (square == 0) & ((beside * beside).sum(axis=1) <= radius**2)
    near, far = middle - rest, middle + rest
    return np.where(inside, -math.inf, near), np.where(inside, math.inf, far)
