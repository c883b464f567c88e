"""Outlines of objects, against rays that meet them or do not."""

import math
from typing import Any

import numpy as np
import pytest

import glrt
from glrt.scene.camera import Camera
from glrt.scene.shapes import mesh as mesh_module
from glrt.scene.shapes.box import Box
from glrt.scene.shapes.cylinder import Cylinder
from glrt.scene.shapes.disk import Disk
from glrt.scene.shapes.faces import STEPS, faces_of_triangles
from glrt.scene.shapes.kinds import KINDS, Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere
from glrt.view.viewport.outline import outline
from glrt.view.viewport.pick import ray_through
from tests.support.meshes import icosphere

CAMERA = Camera(position=(0.4, 0.7, 4.0), look_at=(0.1, 0.0, 0.0), fov=50.0)
ASPECT = 1.5
CYLINDER: Any = {"from": (-0.3, -0.4, 0), "to": (0.4, 0.5, 0.2), "radius": 0.3, "material": "a"}
BALL = icosphere(2)


def ball_mesh(**more: Any) -> Mesh:
    vertices, faces = BALL
    return glrt.Mesh(vertices, faces, material="a", **{"scale": (0.5, 0.7, 0.4), **more})


SHAPES: list[Shape] = [
    Sphere(center=(0.3, 0.1, 0.5), radius=0.6, material="a"),
    Quad(corner=(-0.5, -0.3, 0), edge_u=(1, 0.2, 0.3), edge_v=(0.1, 0.8, -0.4), material="a"),
    Disk(center=(0.1, -0.2, 0.3), normal=(0.3, 1, 0.8), radius=0.7, material="a"),
    Box(min=(-0.4, -0.5, -0.3), max=(0.5, 0.2, 0.6), rotate=(20, 30, 40), material="a"),
    Cylinder(**CYLINDER),
    ball_mesh(rotate=(10, 20, 30), translate=(0.2, 0.1, 0.3)),
]


def is_met(shape: Shape, x: float, y: float) -> bool:
    origin, direction = ray_through(CAMERA, ASPECT, x, y)
    if isinstance(shape, Mesh):
        return shape.distance(origin, direction) < math.inf
    with np.errstate(all="ignore"):
        rows = np.array([shape.row])
        return bool(type(shape).distances(rows, origin, direction)[0] < math.inf)


def test_all_kinds_but_endless_planes_are_tried() -> None:
    assert {type(shape) for shape in SHAPES} | {Plane} == set(KINDS.values())


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.shape)
def test_rays_just_inside_meet_the_object_and_rays_just_outside_do_not(shape: Shape) -> None:
    lines = outline(shape, CAMERA, ASPECT)
    middles = lines.mean(axis=1)
    center = (middles.min(axis=0) + middles.max(axis=0)) / 2
    assert len(lines) >= 4
    for middle in middles:
        inside, outside = (center + share * (middle - center) for share in (0.99, 1.01))
        assert is_met(shape, *inside), middle
        assert not is_met(shape, *outside), middle


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.shape)
def test_an_outline_is_closed(shape: Shape) -> None:
    ends = outline(shape, CAMERA, ASPECT).reshape(-1, 2).round(9)
    _, counts = np.unique(ends, axis=0, return_counts=True)
    assert set(counts % 2) == {0}


def test_faces_that_are_turned_over_change_nothing() -> None:
    vertices, faces = BALL
    faces = faces.copy()
    faces[::3] = faces[::3, ::-1]
    turned = glrt.Mesh(vertices, faces, material="a", scale=(0.5, 0.7, 0.4))
    assert np.array_equal(sorted_lines(turned), sorted_lines(ball_mesh()))


def test_seams_of_a_mesh_are_no_rims() -> None:
    """Vertices of one place that differ in normals or coordinates, as of many files."""
    vertices, faces = BALL
    torn = vertices[faces].reshape(-1, 3)
    seamed = glrt.Mesh(
        torn, np.arange(len(torn)).reshape(-1, 3), material="a", scale=(0.5, 0.7, 0.4)
    )
    assert np.array_equal(sorted_lines(seamed), sorted_lines(ball_mesh()))


def sorted_lines(shape: Shape) -> Any:
    lines = np.sort(outline(shape, CAMERA, ASPECT).round(9), axis=1).reshape(-1, 4)
    return lines[np.lexsort(lines.T)]


def test_a_hole_has_its_rim() -> None:
    vertices, faces = BALL
    holed = glrt.Mesh(vertices, faces[1:], material="a", scale=(0.5, 0.7, 0.4))
    assert len(outline(holed, CAMERA, ASPECT)) in range(
        len(outline(ball_mesh(), CAMERA, ASPECT)), len(outline(ball_mesh(), CAMERA, ASPECT)) + 4
    )
    rims = faces_of_triangles(vertices, faces[1:]).neighbours < 0
    assert rims.any(axis=1).sum() == 3


def test_the_outline_of_a_large_mesh_is_that_of_its_box(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mesh_module, "MOST_OUTLINED", 10)
    vertices, faces = BALL
    turned = glrt.Mesh(vertices, faces, material="a", rotate=(0, 45, 0))
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    box = Box(min=tuple(low), max=tuple(high), rotate=(0, 45, 0), material="a")
    assert np.allclose(sorted_lines(turned), sorted_lines(box), atol=1e-6)


def test_what_comes_behind_the_camera_is_cut() -> None:
    floor = Quad(corner=(-9, -1, -9), edge_u=(0, 0, 18), edge_v=(18, 0, 0), material="a")
    lines = outline(floor, CAMERA, ASPECT)
    assert len(lines) == 3  # the edge behind the camera is gone
    assert np.isfinite(lines).all()
    assert lines[..., 1].min() > 0.2  # below the horizon
    behind = Sphere(center=(0.4, 0.7, 9.0), radius=1.0, material="a")
    assert len(outline(behind, CAMERA, ASPECT)) == 0


def test_a_ball_around_the_camera_has_no_outline() -> None:
    around = Sphere(center=CAMERA.position, radius=1.0, material="a")
    assert len(outline(around, CAMERA, ASPECT)) == 0


def test_a_plane_shows_a_square_in_it() -> None:
    plane = Plane(point=(0, -1, 0), normal=(0, 1, 0), material="a")
    assert len(outline(plane, CAMERA, ASPECT)) == 4


def test_a_circle_has_enough_corners() -> None:
    """Its chords stay within a thousandth of the radius, less than a pixel in most pictures."""
    assert 1 - math.cos(math.pi / STEPS) < 0.0013
