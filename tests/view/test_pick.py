"""The object under a point of the picture, and shapes that are moved by a gizmo."""

import math
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glrt.core.errors import GlrtError
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.scene.shapes.box import rotation
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere
from glrt.view.edits.scene_edits import with_object
from glrt.view.viewport import orbit
from glrt.view.viewport.pick import pick, ray_through
from glrt.view.viewport.transform import (
    can_turn,
    moved_to,
    object_matrix,
    projection_matrix,
    scaled,
    shifted,
    turned,
    view_matrix,
)
from tests.support.builders import box, cylinder, disk, lamp, plane, quad, scene_of, sphere

BALL = sphere([0.5, 0.2, -4], 0.7, "a")
FLOOR = plane([0, -1, 0], [0, 2, 0], "b")
PANE = quad([-3, -0.5, -5], [1.5, 0, 0], [0, 1, 0], "c")
LAMPS = {
    "a": lamp(1.0),
    "b": lamp(10.0),
    "c": lamp(100.0),
    "d": lamp(1000.0),
    "e": lamp(1e4),
    "f": lamp(1e5),
    "g": lamp(1e6),
}
DRUM = cylinder([-2, 1.2, -6], [-1.2, 1.9, -5], 0.5, "f")
TUBE = cylinder([1.0, -0.5, -2.8], [1.7, -0.3, -2.4], 0.3, "g", capped=False)
CRATE = box([-0.2, 0.9, -5], [0.6, 1.5, -4], "e", [20, 30, 40])
PLATE = disk([2, 0.5, -6], [0.2, 0.3, 1], 0.8, "d")
BRIGHTNESSES = [10**n for n in range(7)]
SHAPES: list[Shape] = list(scene_of([BALL, FLOOR, PANE, PLATE, CRATE, DRUM, TUBE], LAMPS).objects)


def test_every_pixel_shows_what_is_picked_there(context: Context) -> None:
    """Lamps of three brightnesses, no light but theirs: a pixel's names its object."""
    scene = scene_of(
        [BALL, FLOOR, PANE, PLATE, CRATE, DRUM, TUBE], LAMPS, {"position": [0.1, 0.3, 0.2]}
    )
    renderer = Renderer(scene, context=context, width=48, height=32, bounces=0)
    seen = renderer.render(16).image().radiance[..., 0]
    renderer.release()
    found = set()
    for row in range(32):
        for column in range(48):
            brightness = float(seen[row, column])
            if brightness in (0, *BRIGHTNESSES):  # all samples agree: no edge lies in the pixel
                picked = pick(scene, 1.5, (column + 0.5) / 48, (row + 0.5) / 32)
                expected = 10**picked.number if picked else 0
                assert brightness == expected, (row, column)
                found.add(brightness)
    assert found == {0, *BRIGHTNESSES}


def test_the_point_picked_lies_on_the_object() -> None:
    scene = scene_of([BALL, FLOOR, PANE], LAMPS)
    depth = math.tan(math.radians(22.5)) * 4
    picked = pick(scene, 1.0, 0.5 + 0.5 * 0.5 / depth, 0.5 - 0.5 * 0.2 / depth)
    assert picked
    assert picked.number == 0
    assert math.dist(picked.point, (0.5, 0.2, -4)) == pytest.approx(0.7)


def test_from_inside_a_ball_its_far_side_is_picked() -> None:
    scene = scene_of([sphere([0, 0, 0], 2, "a")], LAMPS)
    picked = pick(scene, 1.0, 0.5, 0.5)
    assert picked
    assert picked.point == pytest.approx((0, 0, -2))


def test_the_middle_of_the_picture_is_what_the_camera_looks_at() -> None:
    camera = Camera(position=(1.0, 2.0, 3.0), look_at=(0.0, 0.5, -1.0))
    _, direction = ray_through(camera, 1.7, 0.5, 0.5)
    assert np.allclose(direction, orbit.axes(camera)[2])


def project(camera: Camera, aspect: float, point: tuple[float, float, float]) -> list[float]:
    """A point by the matrices of the gizmo, as a share of the picture."""
    view = np.array(view_matrix(camera)).reshape(4, 4).T
    projection = np.array(projection_matrix(camera, aspect)).reshape(4, 4).T
    x, y, _, w = projection @ view @ np.array([*point, 1.0])
    return [float(0.5 + 0.5 * x / w), float(0.5 - 0.5 * y / w)]


def test_the_gizmo_sees_as_the_camera_does() -> None:
    camera = Camera(position=(1.0, 2.0, 3.0), look_at=(0.0, 0.5, -1.0), fov=33.0)
    origin, direction = ray_through(camera, 1.7, 0.8, 0.3)
    point = origin + 4 * direction
    assert project(camera, 1.7, (point[0], point[1], point[2])) == pytest.approx([0.8, 0.3])


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.shape)
def test_a_gizmo_moves_the_middle(shape: Shape) -> None:
    matrix = np.array(object_matrix(shape))
    assert moved_to(shape, matrix.astype(np.float32)) == shape
    matrix[12:15] += [1, 2, 3]
    moved = moved_to(shape, matrix.astype(np.float32))
    assert np.subtract(moved.middle, shape.middle) == pytest.approx([1, 2, 3], abs=1e-6)
    assert moved.reach == pytest.approx(shape.reach)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda shape: shape.shape)
def test_a_gizmo_turns_about_the_middle(shape: Shape) -> None:
    """Where a ray met the shape, the turned ray meets the turned one."""
    turn = rotation((20.0, -35.0, 50.0))
    matrix = np.array(object_matrix(shape)).reshape(4, 4)
    matrix[:3, :3] = turn.T  # rows are images of the axes
    after = moved_to(shape, matrix.ravel().astype(np.float32))
    middle = np.array(shape.middle)
    assert after.middle == pytest.approx(shape.middle, abs=1e-6)
    random = np.random.default_rng(4)
    hits = 0
    for _ in range(100):
        start = random.normal(size=3) * 3
        aim = -start / np.linalg.norm(start) + random.normal(size=3) * 0.1
        with np.errstate(all="ignore"):
            ways = [
                type(it).distances(np.array([it.row]), middle + frame @ start, frame @ aim)[0]
                for it, frame in ((shape, np.eye(3)), (after, turn))
            ]
        assert ways[1] == pytest.approx(ways[0], rel=1e-4, nan_ok=True)
        hits += np.isfinite(ways[0])
    assert hits > 10


def test_a_turn_of_nothing_changes_no_digit() -> None:
    for shape in SHAPES:
        assert turned(shape, np.eye(3)) is shape
    assert not can_turn(next(it for it in SHAPES if it.shape == "sphere"))


def test_shapes_grow_about_their_middle() -> None:
    for shape in SHAPES:
        grown = scaled(shape, 2.0)
        assert grown.middle == pytest.approx(shape.middle)
        factor = 1 if isinstance(shape, Plane) else 2
        assert grown.reach == pytest.approx(factor * shape.reach)


def test_a_scaling_gizmo_scales_by_the_mean_of_its_axes() -> None:
    ball = SHAPES[0]
    matrix = np.array(object_matrix(ball))
    matrix[[0, 5, 10]] = [1.0, 1.5, 0.5]
    assert moved_to(ball, matrix.astype(np.float32)) == ball
    matrix[[0, 5, 10]] = 3.0
    grown = moved_to(ball, matrix.astype(np.float32))
    assert isinstance(grown, Sphere)
    assert grown.radius == pytest.approx(2.1)


def test_a_shifted_quad_keeps_its_edges() -> None:
    pane = SHAPES[2]
    moved = shifted(pane, np.array([0.0, 0.0, 1.0]))
    assert isinstance(moved, Quad)
    assert isinstance(pane, Quad)
    assert (moved.edge_u, moved.edge_v) == (pane.edge_u, pane.edge_v)


def test_only_one_object_is_replaced() -> None:
    scene: Scene = load("cornell")
    moved = shifted(scene.objects[2], np.array([0.0, 0.1, 0.0]))
    after = with_object(scene, 2, moved)
    assert [a == b for a, b in zip(scene.objects, after.objects, strict=True)].count(False) == 1
    assert after.objects[2] == moved


EXTREMES = [0.0, -0.0, 1.0, -1.0, 1e-20, 1e15, -3e38, math.inf, -math.inf, math.nan]
ENTRIES = st.one_of(st.sampled_from(EXTREMES), st.floats(width=32))


@settings(max_examples=300, derandomize=True, deadline=None, database=None)
@given(st.sampled_from(SHAPES), st.lists(ENTRIES, min_size=16, max_size=16))
def test_no_matrix_of_a_gizmo_raises_what_the_window_does_not_catch(
    shape: Shape, entries: list[float]
) -> None:
    with suppress(GlrtError), np.errstate(all="ignore"):
        moved = moved_to(shape, np.array(entries, np.float32))
        assert np.isfinite(moved.middle).all()
        assert moved.reach > 0


@settings(max_examples=200, derandomize=True, deadline=None, database=None)
@given(st.lists(st.floats(-1e15, 1e15), min_size=12, max_size=12), st.floats(1e-15, 1e15))
def test_whatever_lies_there_a_point_is_picked_or_nothing(
    places: list[float], radius: float
) -> None:
    def at(number: int) -> list[float]:
        return places[3 * number : 3 * number + 3]

    shapes = [sphere(at(0), radius, "a"), plane(at(1), [1e-15, 1, 1e15], "b")]
    with suppress(GlrtError):
        shapes.append(quad(at(1), at(2), [1e-15, 0, 1], "c"))
        scene = scene_of(shapes, LAMPS, {"position": at(3), "look_at": [0, 0, 0]})
        picked = pick(scene, 1.0, 0.7, 0.2)
        assert picked is None or not np.isnan(picked.point).any()


def test_the_first_of_objects_in_one_place_is_picked_and_of_none_nothing() -> None:
    scene = scene_of([PANE, FLOOR, BALL, BALL], LAMPS)
    depth = math.tan(math.radians(22.5)) * 4
    picked = pick(scene, 1.0, 0.5 + 0.5 * 0.5 / depth, 0.5 - 0.5 * 0.2 / depth)
    assert picked
    assert picked.number == 2
    assert pick(scene_of([], {}, background={"color": [1, 1, 1]}), 1.0, 0.5, 0.5) is None


@pytest.mark.parametrize("above", [-1e-9, 0.0, 1e-9])
def test_a_lamp_in_the_plane_of_a_wall_is_picked(above: float) -> None:
    """The picture shows it there; the other lamp has a twin, which is not seen."""
    wall = quad([-5, -5, -4], [10, 0, 0], [0, 10, 0], "wall")
    pane = quad([-1, -1, -4 + above], [2, 0, 0], [0, 2, 0], "lamp")
    materials = {"wall": {"type": "lambertian", "color": [0.5] * 3}, "lamp": lamp(1.0)}
    found = pick(scene_of([{**pane, "material": "wall"}, wall, pane], materials), 1.0, 0.5, 0.5)
    assert found
    assert found.number == 2
