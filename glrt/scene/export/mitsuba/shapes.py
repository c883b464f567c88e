"""Shapes in the words of Mitsuba."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from glrt.core.text import quoted
from glrt.scene.export.faces import is_seen_from_inside
from glrt.scene.export.left_out import Report
from glrt.scene.export.meshes import Form, form_of, grid_of_plane
from glrt.scene.export.mitsuba.surfaces import Surfaces
from glrt.scene.export.mitsuba.textures import STRAIGHT, Turn
from glrt.scene.export.mitsuba.words import Words
from glrt.scene.export.placing import (
    Placing,
    Vector,
    around,
    corners,
    length,
    normal_of,
    placed,
    unit,
)
from glrt.scene.export.triangles import Ball, corners_around, triangles_of
from glrt.scene.materials.base import Opaque
from glrt.scene.scene import Scene
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere

GAP = 5e-6  # between the two faces of a lamp, over the extent of the scene
_SHEAR = 1e-6  # cosine between the edges of a quad from which it is no rectangle

# From Mitsuba's coordinates on a ball, about an axis that points up, to glrt's; and for the back of
# a quad, whose edges are swapped.
_ON_A_BALL = np.array([[-1.0, 0, 1], [0, 1, 0], [0, 0, 1]])
_BALL_AXES = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])  # columns: local x, y, z in the world
_SWAPPED = np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, 1]])


@dataclass(frozen=True)
class Shapes:
    """The shapes of a scene."""

    scene: Scene
    at: Placing
    surfaces: Surfaces
    report: Report  # takes each thing that Mitsuba does not show
    one_sided: bool  # whether flat lamps light their front alone
    reach: float | None  # of planes, over the extent of the scene; None: to the horizon
    forms: dict[object, Form] = field(default_factory=dict)  # of meshes, by what they share

    def of(self, item: Any, name: str) -> Iterator[Words]:
        """Yield the shape, or its parts; nothing for a kind that Mitsuba lacks."""
        if isinstance(item, Sphere):
            yield from self._sphere(item)
        elif isinstance(item, Plane):
            yield self._plane(item, name)
        elif isinstance(item, Quad | Disk):
            yield from self._flat(item, name)
        elif isinstance(item, Box | Cylinder):
            yield from self._solid(item, name)
        elif isinstance(item, Mesh):
            yield self._mesh(item, name)
        else:
            self.report(f"{quoted(name)}, a {item.shape}")

    def _is_lamp(self, item: Any) -> bool:
        return any(self.scene.emission_of(item))

    def _surface(self, item: Any, turn: Turn = STRAIGHT) -> Words:
        finish = self.scene.finish(item)
        found = {"bsdf": self.surfaces.scattering(finish, turn)}
        return {**found, **self.surfaces.emitter(finish, turn)}

    def _has_images(self, item: Any) -> bool:
        material = self.scene.materials[item.material]
        return isinstance(material, Opaque) and bool(material.textures)

    def _sphere(self, item: Sphere) -> Iterator[Words]:
        center, radius = self.at.point(item.center), item.radius * self.at.factor
        if self._has_images(item):
            axes = placed(center, *(radius * _BALL_AXES.T))
            yield {"type": "sphere", "to_world": axes, **self._surface(item, _ON_A_BALL)}
            return
        ball = {"type": "sphere", "center": center.tolist(), **self._surface(item)}
        yield {**ball, "radius": radius}
        if self._is_lamp(item) and is_seen_from_inside(item, self.scene):
            inner = radius - GAP * self.at.extent
            yield {**ball, "radius": inner, "flip_normals": True}

    def _plane(self, item: Plane, name: str) -> Words:
        """Return a plane, around the foot of the origin."""
        surface = self._surface(item)
        if "emitter" in surface:
            self.report(f"the light of {quoted(name)}, a lamp without end")
            del surface["emitter"]
        grid = grid_of_plane(item, self.at, self.reach)
        return _mesh_of(grid if self._has_images(item) else grid._replace(uv=None), surface)

    def _flat(self, item: Quad | Disk, name: str) -> Iterator[Words]:
        """Yield the faces of a flat shape: a lamp has two, which face away from each other."""
        half = GAP / 2 * self.at.extent
        is_lamp = self._is_lamp(item) and not item.is_one_sided
        lifts = ((half,) if self.one_sided else (half, -half)) if is_lamp else (0.0,)
        for lift in lifts:
            if isinstance(item, Quad):
                yield self._quad(item, lift)
            elif self._has_images(item):
                yield self._painted_disk(item, name)
            else:
                normal = normal_of(item)
                place = self.at.point(item.center) + lift * normal, item.radius * self.at.factor
                facing = normal if lift >= 0 else -normal
                yield {**self._surface(item), **_circle(place[0], facing, place[1])}

    def _painted_disk(self, item: Disk, name: str) -> Words:
        found = triangles_of(item, Ball(np.zeros(3), 1.0), corners_around(1))
        assert found is not None
        self.report(f"the roundness of {quoted(name)}, a disk with an image")
        form = Form(self.at.point(found.points), found.faces, None, found.uv)
        return _mesh_of(form, self._surface(item))

    def _quad(self, item: Quad, lift: float) -> Words:
        u, v = self.at.along(item.edge_u) / 2, self.at.along(item.edge_v) / 2
        center = np.mean([self.at.point(corner) for corner in corners(item)], axis=0)
        center += lift * normal_of(item)
        surface = self._surface(item, _SWAPPED if lift < 0 and self._has_images(item) else STRAIGHT)
        if lift < 0:
            u, v = v, u
        if abs(np.dot(u, v)) <= _SHEAR * length(u) * length(v):
            axes = placed(center, u, v, unit(np.cross(u, v)))
            return {**surface, "type": "rectangle", "to_world": axes}
        points = np.array([center - u - v, center + u - v, center + u + v, center - u + v])
        uv = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]]) if self._has_images(item) else None
        return _mesh_of(Form(points, np.array([[0, 1, 2], [0, 2, 3]]), None, uv), surface)

    def _solid(self, item: Box | Cylinder, name: str) -> Iterator[Words]:
        """Yield a box, or the wall and the ends of a cylinder; lamps shine outwards."""
        surface, is_lamp = self._surface(item), self._is_lamp(item)
        is_around = length(np.subtract(item.middle, self.scene.camera.position)) < item.reach
        if is_lamp and is_around:
            self.report(f"the light inside {quoted(name)}")
        if isinstance(item, Box):
            halves = self.at.along(item.axes * item.halves[:, None])
            place = placed(self.at.point(item.middle), *halves)
            yield {"type": "cube", "to_world": place, **surface}
            return
        ends = [self.at.point(item.from_), self.at.point(item.to)]
        radius = item.radius * self.at.factor
        wall = {"type": "cylinder", "p0": ends[0].tolist(), "p1": ends[1].tolist(), **surface}
        yield {**wall, "radius": radius}
        if item.capped:
            for end, outward in zip(ends, (-item.axis, item.axis), strict=True):
                yield {**surface, **_circle(end, outward, radius)}
        elif is_lamp:
            inner = radius - GAP * self.at.extent
            yield {**wall, "radius": inner, "flip_normals": True}

    def _mesh(self, item: Mesh, name: str) -> Words:
        """Return a mesh in coordinates of its file; a lamp shines outwards."""
        if self._is_lamp(item) and item.triangles.opening and not item.is_one_sided:
            self.report(f"the light from the backs of {quoted(name)}")
        if item.hides_backs:
            self.report(f"the hidden backs of {quoted(name)}")
        if item.triangles.colors is not None:
            self.report(f"the colors of the vertices of {quoted(name)}")
        surface, material = self._surface(item), self.scene.materials[item.material]
        images = material.textures if isinstance(material, Opaque) else {}
        uv_set = min((it.uv for it in images.values()), default=0)
        words = _mesh_of(self._form(item, uv_set), surface)
        return {**words, "to_world": self.at.matrix(item.linear, item.origin)}

    def _form(self, item: Mesh, uv_set: int) -> Form:
        """Return the triangles; meshes of one form share them."""
        key = item.form, item.smooth, uv_set, item.is_upright
        if key not in self.forms:
            form = form_of(item, uv_set)
            if not item.is_upright:  # Mitsuba takes the side from the corners of a triangle
                form = form._replace(faces=form.faces[:, ::-1])
            self.forms[key] = form
        return self.forms[key]


def _mesh_of(form: Form, surface: Words) -> Words:
    return {"type": "mesh", "form": form, **surface}


def _circle(center: Vector, normal: Vector, radius: float) -> Words:
    u, v = (radius * axis for axis in around(normal))
    return {"type": "disk", "to_world": placed(center, u, v, normal)}
