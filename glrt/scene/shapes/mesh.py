"""Triangle meshes in a scene: file and part, placement, and normals."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field

from glrt.scene.files.named_meshes import MeshFile, NamedMesh, mesh_of_arrays
from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.shapes.base import Array, Frame, Sided, along_and_rest
from glrt.scene.shapes.box import rotation
from glrt.scene.shapes.faces import Faces, box_faces, faces_of_triangles, welded
from glrt.scene.shapes.mesh_rays import nearest, winds_around
from glrt.scene.shapes.mesh_values import Factors, Matrix
from glrt.scene.values import LARGEST, Name, Number, Triple, Vector
from glrt.settings import Cost, Editable

Smooth = Literal[True, False, "auto"]
Backs = Literal["both", "hidden"]
MOST_OUTLINED = 200_000  # triangles whose edges may make an outline


class Mesh(Sided):
    """Triangles of a file, transformed by its matrix, then scaled, then turned, then moved.

    Python code may give arrays instead, `glrt.Mesh(vertices, faces, normals=None, colors=None,
    uv=None, material=...)`. These are the places of vertices, (v, 3), and the numbers of each
    triangle's vertices, (n, 3), counter-clockwise seen from outside. At each vertex there may be
    normals, (v, 3); linear colours, (v, 3) of 0 to 1, by which the colour of the material is
    multiplied; and texture coordinates, (v, 2), with (0, 0) in the upper left of an image. Such a
    mesh is saved next to its scene.
    """

    shape: Literal["mesh"] = Field("mesh", description="the kind of shape")
    file: NamedMesh = Field(
        description="path of a model, .glb, .gltf, .obj, .ply, .stl, .usd, .usda, .usdc, .usdz or "
        ".mtlx"
    )
    material: str = Field(
        "",
        pattern=r"^[^\x00-\x1f\x7f]*$",
        description="name of one of the materials; default: those of the file, which OBJ, glTF, "
        "USD and MaterialX files have",
    )
    part: Name | None = Field(
        None,
        description="name of a material of the file, whose triangles alone are taken; default: all",
    )
    translate: Vector = Field((0.0, 0.0, 0.0), description="where the origin of the file lies")
    rotate: Vector = Field(
        (0.0, 0.0, 0.0),
        description="angles in degrees about the x, then the y, then the z axis, through that "
        "origin",
    )
    scale: Factors = Field(
        (1.0, 1.0, 1.0),
        description="a factor of its size, or one along each axis of the file; negative: mirrored",
    )
    matrix: Matrix | None = Field(
        None,
        description="four rows of four numbers, by which points of the file are multiplied, as "
        "columns, before they are scaled; default: they stay as they are",
    )
    time: Annotated[float | None, Editable(Cost.RESTART, "seconds")] = Field(
        None,
        ge=0,
        le=LARGEST,
        description="moment of an animation of a glTF file; default: the pose without animation",
    )
    animation: Name | None = Field(
        None,
        description="name of that animation, or its number from 0; default: the first that moves",
    )
    variant: Name | None = Field(
        None,
        description="name of a variant of the materials of a glTF file, or its number from 0 where "
        "it has no name; default: the materials without a variant",
    )
    smooth: Annotated[Smooth, Editable(Cost.RECOMPILE)] = Field(
        True,
        description="whether normals are interpolated, those of the file or, where it has none, "
        "means at each vertex; false: flat facets; auto: as the format means it, flat for STL, by "
        "smoothing groups for OBJ, and with edges sharp by crease for PLY",
    )
    crease: Annotated[float, Editable(Cost.RESTART, "degrees", (0, 180))] = Field(
        40.0,
        ge=0,
        le=180,
        description="angle between triangles from which an edge is sharp, with smooth = auto",
    )

    backfaces: Annotated[Backs, Editable(Cost.RECOMPILE)] = Field(
        "both",
        description="whether both sides of triangles are there; hidden: rays pass triangles that "
        "they meet from behind, and lamps emit from their front alone",
    )

    has_inside = True
    has_coordinates = True
    anchor = "translate"
    extents = ("scale",)

    if TYPE_CHECKING:

        def __init__(
            self,
            vertices: Any = None,
            faces: Any = None,
            normals: Any = None,
            colors: Any = None,
            uv: Any = None,
            *,
            file: MeshFile | str | None = None,
            translate: Triple = (0, 0, 0),
            rotate: Triple = (0, 0, 0),
            scale: Number | Triple = 1,
            matrix: Sequence[Sequence[Number]] | Array | None = None,
            time: Number | None = None,
            animation: str | None = None,
            variant: str | None = None,
            smooth: Smooth = True,
            crease: Number = 40.0,
            backfaces: Backs = "both",
            material: str = "",
            part: str | None = None,
            name: str | None = None,
            group: str | None = None,
            medium: str | None = None,
            hidden: bool = False,
            emission_side: Literal["both", "front"] = "both",
        ) -> None: ...

    else:

        def __init__(self, vertices=None, faces=None, normals=None, colors=None, uv=None, **fields):
            """Take arrays or a file; raises ValueError, which says what is wrong with which row."""
            if vertices is not None or faces is not None:
                if "file" in fields:
                    raise ValueError("a mesh is given by arrays or by a file, not by both")
                fields["file"] = mesh_of_arrays(vertices, faces, normals, colors, uv)
            super().__init__(**fields)

    @property
    def triangles(self) -> TriangleMesh:
        """Triangles of the part in file coordinates; ValueError if unread, or without the part."""
        mesh = self.triangles_of_file
        if self.part is None:
            return mesh
        if self.part not in mesh.parts:
            raise ValueError(f"the file {self.file.file} has no part {self.part}")
        return mesh.parts[self.part]

    @property
    def triangles_of_file(self) -> TriangleMesh:
        """Triangles of all parts; ValueError before the file is read."""
        if (whole := self.file.triangles) is None:
            raise ValueError(f"the file {self.file.file} was not read")
        if self.time is not None:
            if whole.poses is None:
                raise ValueError("it has no animation: leave `time` out")
            whole = whole.poses.at(self.animation, self.time)
        whole = whole.varied(self.variant)
        return whole.creased(self.crease) if self.smooth == "auto" else whole

    @property
    def form(self) -> tuple[object, ...]:
        """The triangles by name: meshes of one form share them, wherever they stand."""
        crease = self.crease if self.smooth == "auto" else None
        own = self.part, self.variant, crease, self.animation, self.time
        return self.file.sha256, *own, self.hides_backs

    @property
    def hides_backs(self) -> bool:
        """Whether rays pass its triangles from behind."""
        return self.backfaces == "hidden"

    @property
    def is_one_sided(self) -> bool:
        """Whether it emits from its front alone."""
        return super().is_one_sided or self.hides_backs

    @property
    def linear(self) -> Array:
        """Matrix from the axes of the file to those of the scene, (3, 3)."""
        turned: Array = self._turned() @ self._given()[:, :3]
        return turned

    @property
    def origin(self) -> Array:
        """Where the origin of the file lies in the scene, (3,)."""
        moved: Array = self._turned() @ self._given()[:, 3] + np.array(self.translate)
        return moved

    def _turned(self) -> Array:
        turned: Array = rotation(self.rotate) * np.array(self.scale)
        return turned

    def _given(self) -> Array:
        return np.eye(4)[:3] if self.matrix is None else np.array(self.matrix)[:3]

    @property
    def world_vertices(self) -> Array:
        """Vertices in scene units, (v, 3)."""
        vertices: Array = self.triangles.vertices @ self.linear.T + self.origin
        return vertices

    @property
    def world_normals(self) -> Array:
        """Normals in the scene, (v, 3), of any length: turned by the inverse, transposed.

        They point outwards if the normals of the file do.
        """
        turned: Array = self.triangles.shading_normals @ np.linalg.inv(self.linear)
        return turned

    @property
    def is_upright(self) -> bool:
        """Whether the mesh is not mirrored."""
        return bool(np.linalg.det(self.linear) > 0)

    @property
    def frame(self) -> Frame:
        """The frame of the file."""
        return Frame(self.linear, self.origin, *self.triangles.box)

    @property
    def middle(self) -> Vector:
        """Middle of the box around the mesh, in its own axes; its origin if it is unread."""
        center = self.frame.middle if self.file.is_read else self.origin
        x, y, z = (float(value) for value in center)
        return (x, y, z)

    @property
    def reach(self) -> float:
        """Distance from the middle to the farthest corner of the mesh's box; 0 if unread."""
        if self.file.triangles is None:
            return 0.0
        low, high = self.triangles.box
        signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        corners = (signs * (high - low) / 2) @ self.linear.T
        return float(np.linalg.norm(corners, axis=1).max())

    @property
    def row(self) -> list[float]:
        """Middle and radius of a ball that holds the mesh."""
        return [*self.middle, self.reach]

    def outline(self, about: Array) -> Array:
        """Return the triangles relative to `about`, (n, 9), each with its corners sorted."""
        corners = self.polygons - about
        order = np.lexsort(corners.transpose(2, 0, 1), axis=-1)
        rows: Array = np.take_along_axis(corners, order[..., None], axis=1).reshape(-1, 9)
        return rows

    @property
    def polygons(self) -> Array:
        """Triangles in scene units, (n, 3, 3)."""
        corners: Array = self.world_vertices[self.triangles.faces]
        return corners

    def holds(self, point: Array) -> bool:
        """Return whether the mesh winds around a point, (3,) (van Oosterom and Strackee 1983)."""
        if np.linalg.norm(point - self.middle) > self.reach:
            return False
        return winds_around(self.world_vertices - point, self.triangles.faces)

    @property
    def faces(self) -> Faces:
        """The triangles, or the box around them if they are more than MOST_OUTLINED."""
        triangles = self.triangles
        if len(triangles.faces) > MOST_OUTLINED:
            axes, _, low, high = self.frame
            return box_faces(self.frame.middle, (axes * ((high - low) / 2)).T)
        corners = welded(triangles.vertices)[triangles.faces]
        return faces_of_triangles(self.world_vertices, corners)

    @classmethod
    def example(cls, place: Array, size: float) -> dict[str, Any]:
        """Return no fields: a mesh comes from a file."""
        return {}

    @staticmethod
    def bounds(rows: Array) -> tuple[Array, Array]:
        """Return low and high corners of boxes around balls, (n, 3) each."""
        return rows[:, :3] - rows[:, 3:], rows[:, :3] + rows[:, 3:]

    @staticmethod
    def distances(rows: Array, origin: Array, direction: Array) -> Array:
        """Return where rays enter the ball, (n,), 0 from inside; `distance` finds triangles."""
        along, rest = along_and_rest(rows, origin, direction)
        return np.where(along + rest > 0, np.maximum(along - rest, 0), math.inf)

    def distance(self, origin: Array, direction: Array) -> float:
        """Return how far a ray goes to the nearest triangle; inf for a miss."""
        inverse = np.linalg.inv(self.linear)
        start, along = inverse @ (origin - self.origin), inverse @ direction
        mesh = self.triangles
        return nearest(mesh.vertices - start, mesh.faces, along, self.hides_backs)
