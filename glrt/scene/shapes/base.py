"""Base classes of shapes, and arithmetic that several share."""

import math
from abc import abstractmethod
from collections.abc import Sequence
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from glrt.scene.shapes.faces import Faces
from glrt.scene.shapes.flat_faces import FlatFace
from glrt.scene.shapes.texture_axes import TextureAxes, axes_across
from glrt.scene.values import Name, Tagged, Vector
from glrt.settings import Cost, Editable

Array = NDArray[np.float64]
UP = np.array([0.0, 1.0, 0.0])


class LampBody(NamedTuple):
    """Place and extent of a lamp, by which light sampling chooses it."""

    area: float  # of both sides; of the outside alone for a sphere
    center: Array  # (3,), float64
    spread2: float  # mean squared distance of its points from the center
    reach: float  # the largest such distance
    normal: Array  # (3,), of any length; 0 for a sphere


class Frame(NamedTuple):
    """A frame in which a shape lies, and the box around the shape in it.

    A point q of the frame is axes @ q + origin in the world.
    """

    axes: Array  # (3, 3)
    origin: Array  # (3,)
    low: Array  # (3,), corner of the box with the least coordinates
    high: Array  # (3,)

    @property
    def middle(self) -> Array:
        """Middle of the box, in the world."""
        middle: Array = self.axes @ ((self.low + self.high) / 2) + self.origin
        return middle


class Object(Tagged):
    """A shape with a name and a material, and methods for its geometry."""

    name: Name | None = Field(None, description="name of the object in messages and the window")
    material: Name = Field(description="name of one of the materials")
    group: Name | None = Field(
        None,
        description="light group whose intensity its emission follows; default: that of its "
        "material",
    )
    medium: Annotated[Name | None, Editable(Cost.RECOMPILE)] = Field(
        None,
        description="name of the medium inside, for an object of glass or of a material of type "
        "none; default: vacuum",
    )
    priority: Annotated[
        int | None, Field(ge=-1000, le=1000), Editable(Cost.RECOMPILE, "", (-10, 10))
    ] = Field(
        None,
        description="where objects that bound volumes overlap, the one of the highest priority is "
        "there, in a scene with media; default: that of its glass, or else 0",
    )
    hidden: Annotated[bool, Editable(Cost.RECOMPILE)] = Field(
        False, description="whether it is left out of the picture"
    )

    has_inside: ClassVar[bool]  # whether the kind can be of glass
    has_coordinates: ClassVar[bool] = False  # whether textures can lie on it
    anchor: ClassVar[str]  # the field with a point that moves with the shape
    points: ClassVar[tuple[str, ...]] = ()  # fields with further points, which move along
    directions: ClassVar[tuple[str, ...]] = ()  # fields with vectors that turn with the shape
    extents: ClassVar[tuple[str, ...]]  # the fields, lengths or vectors, that grow with its size

    @property
    def is_one_sided(self) -> bool:
        """Whether the shape emits from its front alone."""
        return False

    @property
    def encloses(self) -> bool:
        """Whether this shape encloses a volume, so that it can be of glass."""
        return self.has_inside

    @property
    @abstractmethod
    def middle(self) -> Vector:
        """The point by which the shape is moved and about which it is scaled."""

    @property
    @abstractmethod
    def reach(self) -> float:
        """Radius of a ball about the middle that holds the shape; infinite if none does."""

    @property
    @abstractmethod
    def row(self) -> list[float]:
        """Numbers of the shape, as `bounds` and `distances` take them."""

    @abstractmethod
    def outline(self, about: Array) -> Array:
        """Return rows, (n, k), that describe the shape relative to `about`, (3,), in any order.

        Shapes of a kind are equal if these rows are, whichever way the shapes were given.
        """

    @property
    def is_bounded(self) -> bool:
        """Whether the shape ends: some ball holds it."""
        return math.isfinite(self.reach)

    @property
    def frame(self) -> Frame:
        """The frame that turns and grows with the shape: that of the world, unless it has one."""
        low, high = self.bounds(np.array([self.row], np.float64))
        return Frame(np.eye(3), np.zeros(3), low[0], high[0])

    @property
    def placement(self) -> Array:
        """Axes and origin, (3, 4), of a frame fixed to the surface: it moves, turns and grows."""
        frame = self.frame
        size = frame.high - frame.low
        return np.column_stack([frame.axes * np.where(size == 0, 1.0, size), frame.middle])

    @property
    def lamp_body(self) -> LampBody | None:
        """Place and extent as a lamp.

        None for a kind that light sampling and particles do not know; paths find it by scattering.
        """
        return None

    @property
    def texture_axes(self) -> TextureAxes | None:
        """Axes of texture coordinates; None if the kernel has another rule for the kind."""
        return None

    @property
    def flat_faces(self) -> Sequence[FlatFace]:
        """Flat faces of a solid, to find solids that share a part of a plane."""
        return ()

    def holds(self, point: Array) -> bool:
        """Return whether a point, (3,), lies inside a shape that encloses a volume.

        A shape that is not convex has its own rule: from inside a convex one, a line leaves it
        both ways.
        """
        rows, line = np.array([self.row], np.float64), np.array([0.6, 0.64, 0.48])
        with np.errstate(divide="ignore", invalid="ignore"):
            ways = [self.distances(rows, point, way)[0] for way in (line, -line)]
        return bool(np.isfinite(ways).all())

    @property
    @abstractmethod
    def polygons(self) -> Array:
        """Flat surfaces as convex polygons in scene units, (n, k, 3), with corners in order round.

        Round surfaces and infinite planes have none. A triangle among quads repeats its last
        corner.
        """

    @property
    @abstractmethod
    def faces(self) -> Faces | None:
        """Flat faces, or strips in place of round ones; None for a ball.

        A window draws the shape's outline by them.
        """

    @classmethod
    @abstractmethod
    def example(cls, place: Array, size: float) -> dict[str, Any]:
        """Return fields of a new shape about a place, (3,), that reaches about `size` from there.

        They are empty for a kind that needs a file.
        """

    @staticmethod
    @abstractmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Return low and high corners of boxes around n shapes, (n, 3) each; infinite for planes.

        The boxes are aligned with the axes.
        """

    @classmethod
    def gaps(cls, rows: Array, point: Array) -> Array:
        """Return distances from a point, (3,), to n shapes or to the boxes around them, (n,)."""
        return np.asarray(np.linalg.norm(point - np.clip(point, *cls.bounds(rows)), axis=1))

    @staticmethod
    @abstractmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """Return how far a ray goes to each of n shapes, (n,); inf for a miss or a shape behind.

        Or n rays, (n, 3) each, to one shape.
        """


NO_POLYGONS = np.zeros((0, 3, 3))


class Cornerless(Object):
    """A shape without flat surfaces that end: it is round or infinite."""

    @property
    def polygons(self) -> Array:
        """No polygons, (0, 3, 3)."""
        return NO_POLYGONS


class Sided(Object):
    """A shape that can emit from its front alone."""

    emission_side: Annotated[Literal["both", "front"], Editable(Cost.RECOMPILE)] = Field(
        "both",
        description="side that emits: both, or the front alone, to which the normal points",
    )

    @property
    def is_one_sided(self) -> bool:
        """Whether the shape emits from its front alone."""
        return self.emission_side == "front"


_CORNERS = 12  # corners of a polygon in a circle


def ring(center: Array, normal: Array, radius: float) -> Array:
    """Return a regular polygon in a circle, (_CORNERS, 3)."""
    u = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    u /= np.linalg.norm(u)
    angles = 2 * math.pi * np.arange(_CORNERS)[:, None] / _CORNERS
    points: Array = center + radius * (np.cos(angles) * u + np.sin(angles) * np.cross(normal, u))
    return points


def about_axis(axis: Any, middle: Any, radius: float = 1.0, half: float = 1.0) -> Array:
    """Return axes and origin, (3, 4), of a frame whose third axis lies along `axis`, (3,)."""
    unit = np.array(axis, np.float64) / np.linalg.norm(axis)
    u, v = axes_across(unit)
    return np.column_stack([radius * u, radius * v, half * unit, middle])


def unsigned(normal: Vector) -> Array:
    """Return the unit vector that a normal and its opposite share, (3,)."""
    unit: Array = np.array(normal) / np.linalg.norm(normal)
    return unit if unit[np.abs(unit).argmax()] > 0 else -unit


def dots(vectors: Array, direction: Array) -> Array:
    """Return dot products, (n,), of n vectors with a direction, or with n directions."""
    products: Array = (vectors * direction).sum(axis=-1)
    return products


def along_and_rest(rows: Array, origin: Array, direction: Array) -> tuple[Array, Array]:
    """Return how far a ray goes to the middle of its chord through n balls, and half the chord.

    Both are (n,). `rows` are centre and radius; the half chord is NaN for a ray that misses.
    """
    to_center = rows[:, :3] - origin
    along = dots(to_center, direction)
    aside = to_center - along[:, None] * direction
    return along, np.sqrt(rows[:, 3] ** 2 - np.square(aside).sum(axis=1))


def to_planes(points: Array, normals: Array, origin: Array, direction: Array) -> Array:
    """Return how far a ray goes to planes by points and normals, (n, 3) each; inf behind it."""
    distances: Array = ((points - origin) * normals).sum(axis=1) / dots(normals, direction)
    return np.where(distances > 0, distances, math.inf)
