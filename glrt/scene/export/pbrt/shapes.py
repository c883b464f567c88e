"""Shapes in the words of pbrt."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from glrt.core.text import quoted
from glrt.scene.export.companions import Companions, ply_of
from glrt.scene.export.left_out import Report
from glrt.scene.export.meshes import Form, form_of, grid_of_plane
from glrt.scene.export.pbrt.materials import Materials
from glrt.scene.export.pbrt.text import directive, transform, with_parameters
from glrt.scene.export.pbrt.textures import lying
from glrt.scene.export.placing import Placing, around, corners, normal_of, placed
from glrt.scene.export.triangles import Ball, corners_around, triangles_of
from glrt.scene.lit_scene import Finish
from glrt.scene.materials.base import Opaque
from glrt.scene.materials.textures import Texture
from glrt.scene.scene import Scene
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere

_AXES = np.eye(3)


@dataclass
class Shapes:
    """The shapes of a file."""

    scene: Scene
    at: Placing  # the coordinates of the scene itself
    materials: Materials
    companions: Companions
    report: Report  # takes each thing that pbrt does not show
    lines: list[str] = field(default_factory=list)  # definitions of instances
    _marks: dict[object, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._counts = Counter(self._key(it) for it in self.scene.meshes)

    def of(self, item: Any, name: str, around_it: list[str]) -> Iterator[str]:
        """Yield the lines of a shape; `around_it` are directives that come before it."""
        finish = self.scene.finish(item)
        if isinstance(item, Mesh):
            self._report_mesh(item, name)
            if self._counts[self._key(item)] > 1 and not around_it and not self._light(item):
                yield transform(self.at.matrix(item.linear, item.origin))
                yield directive("ObjectInstance", self._mark(item, finish))
                return
        yield from around_it
        yield self.materials.of(finish)
        light = self._light(item)
        if isinstance(item, Plane) and light:
            self.report(f"the light of {quoted(name)}, a lamp without end")
            light = []
        yield from light
        yield from self._parts(item, name, self.materials.holes(finish))

    def _parts(self, item: Any, name: str, holes: dict[str, Any]) -> Iterator[str]:
        images = self._images(item)
        if isinstance(item, Mesh):
            yield transform(self.at.matrix(item.linear, item.origin))
            yield self._ply(form_of(item, _uv_set(images)), images, holes)
        elif isinstance(item, Plane):
            yield self._ply(grid_of_plane(item, self.at), images, holes)
        elif isinstance(item, Quad):
            yield _quad(item, images, holes)
        elif isinstance(item, Box) or (images and isinstance(item, Sphere | Disk)):
            yield self._triangles(item, name, images, holes)
        elif isinstance(item, Sphere):
            yield transform(placed(item.center, *_AXES))
            yield _shape("sphere", {"float radius": item.radius, **holes})
        elif isinstance(item, Disk):
            yield from _disk(item.center, normal_of(item), item.radius, holes)
        elif isinstance(item, Cylinder):
            yield from _cylinder(item, holes)
        else:
            self.report(f"{quoted(name)}, a {item.shape}")

    def _light(self, item: Any) -> list[str]:
        return self.materials.light(self.scene.finish(item))

    def _images(self, item: Any) -> dict[str, Texture]:
        material = self.scene.materials[item.material]
        return material.textures if isinstance(material, Opaque) else {}

    def _key(self, item: Mesh) -> object:
        return item.form, item.smooth, item.material, _uv_set(self._images(item))

    def _mark(self, item: Mesh, finish: Finish) -> str:
        """Return the name of the object that a mesh is an instance of; define it first."""
        key = self._key(item)
        if key not in self._marks:
            self._marks[key] = f"mesh {len(self._marks)}"
            images = self._images(item)
            form = form_of(item, _uv_set(images))
            self.lines += [
                directive("ObjectBegin", self._marks[key]),
                self.materials.of(finish),
                self._ply(form, images, self.materials.holes(finish)),
                "ObjectEnd",
            ]
        return self._marks[key]

    def _ply(self, form: Form, images: dict[str, Texture], holes: dict[str, Any]) -> str:
        uv = None if form.uv is None or not images else lying(form.uv, images)
        path = self.companions.add("mesh", ".ply", ply_of(form._replace(uv=uv)))
        return _shape("plymesh", {"string filename": path, **holes})

    def _triangles(
        self, item: Any, name: str, images: dict[str, Texture], holes: dict[str, Any]
    ) -> str:
        found = triangles_of(item, Ball(np.zeros(3), 1.0), corners_around(1))
        assert found is not None
        if not isinstance(item, Box):
            self.report(f"the roundness of {quoted(name)}, a {item.shape} with an image")
        normals = found.normals if isinstance(item, Sphere) else None
        return self._ply(Form(found.points, found.faces, normals, found.uv), images, holes)

    def _report_mesh(self, item: Mesh, name: str) -> None:
        if item.hides_backs:
            self.report(f"the hidden backs of {quoted(name)}")
        if item.triangles.colors is not None:
            self.report(f"the colors of the vertices of {quoted(name)}")


def _uv_set(images: dict[str, Texture]) -> int:
    return min((it.uv for it in images.values()), default=0)


def _shape(kind: str, words: dict[str, Any]) -> str:
    return with_parameters(directive("Shape", kind), words)


def _quad(item: Quad, images: dict[str, Texture], holes: dict[str, Any]) -> str:
    first, second, third, fourth = corners(item)
    uv = lying(np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]]), images)
    words = {"point3 P": np.array([first, second, fourth, third]), "point2 uv": uv}
    return _shape("bilinearmesh", {**words, **holes})


def _disk(center: Any, normal: Any, radius: float, holes: dict[str, Any]) -> Iterator[str]:
    yield transform(placed(center, *around(normal), normal))
    yield _shape("disk", {"float radius": radius, **holes})


def _cylinder(item: Cylinder, holes: dict[str, Any]) -> Iterator[str]:
    ends = np.array(item.from_, np.float64), np.array(item.to, np.float64)
    high = float(np.linalg.norm(ends[1] - ends[0]))
    words = {"float radius": item.radius, "float zmin": 0.0, "float zmax": high}
    yield "AttributeBegin"
    yield transform(placed(ends[0], *around(item.axis), item.axis))
    yield _shape("cylinder", {**words, **holes})
    yield "AttributeEnd"
    if item.capped:
        for end, outward in zip(ends, (-item.axis, item.axis), strict=True):
            yield "AttributeBegin"
            yield from _disk(end, outward, item.radius, holes)
            yield "AttributeEnd"
