"""The line around a mesh in the picture, against rays that meet the mesh or do not."""

from collections.abc import Iterator
from typing import Any

import moderngl
import numpy as np
import pytest

import glrt
from glrt.scene.camera import Camera
from glrt.scene.shapes.mesh import Mesh
from glrt.view.controls import replaced
from glrt.view.state.zoom import Rectangle
from glrt.view.viewport.silhouette import Silhouette
from tests.view.test_outline import CAMERA, ball_mesh, is_met

WIDTH, HEIGHT = 96, 64  # of the aspect that `is_met` takes
PLACE: Rectangle = (10.0, 20.0, float(WIDTH), float(HEIGHT))
MESH = ball_mesh(rotate=(10, 20, 30), translate=(0.2, 0.1, 0.3))
CORNERS = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], float)
SIDES = [(x, y, z) for x in (0, 1) for y in (2, 3) for z in (4, 5)]
FAR = 4  # pixels that the line reaches, at most


@pytest.fixture
def silhouette(ctx: moderngl.Context) -> Iterator[Silhouette]:
    drawn = Silhouette(ctx)
    yield drawn
    drawn.release()


def alpha(
    silhouette: Silhouette,
    *meshes: Mesh,
    camera: Camera = CAMERA,
    seen: Rectangle = PLACE,
) -> Any:
    """Opacity of the line, of MESH if none is given; row 0 on top."""
    texture = silhouette.draw(meshes or (MESH,), camera, PLACE, seen)
    rows = np.frombuffer(texture.read(), np.uint8).reshape(texture.height, texture.width, 4)
    return rows[::-1, :, 3] / 255


def octahedron(**more: Any) -> Mesh:
    """In the same box as the ball of MESH."""
    return glrt.Mesh(CORNERS, SIDES, material="a", **{"scale": (0.5, 0.7, 0.4), **more})


def covered() -> Any:
    """The pixels whose middle a ray through the mesh passes, (HEIGHT, WIDTH)."""
    places = [((x + 0.5) / WIDTH, (y + 0.5) / HEIGHT) for y in range(HEIGHT) for x in range(WIDTH)]
    return np.array([is_met(MESH, x, y) for x, y in places]).reshape(HEIGHT, WIDTH)


def test_the_line_lies_around_the_mesh_and_leaves_it_free(silhouette: Silhouette) -> None:
    line, inside = alpha(silhouette), covered()
    assert 200 < inside.sum() < 0.5 * inside.size
    around = np.zeros_like(inside)
    near = np.zeros_like(inside)
    for y in range(-FAR, FAR + 1):
        for x in range(-FAR, FAR + 1):
            moved = np.roll(inside, (y, x), (0, 1))
            near |= moved & (abs(y) + abs(x) <= 1)
            around |= moved
    assert (line[inside] > 0).mean() < 0.01  # of rays through the very rim
    assert (line[near & ~inside] == 1).mean() > 0.99
    assert (line[~around] == 0).all()


def test_a_magnified_part_has_the_line_of_that_part(silhouette: Silhouette) -> None:
    whole = alpha(silhouette)
    seen = (10.0 + 16, 20.0 + 8, 48.0, 40.0)
    part = alpha(silhouette, seen=seen)
    assert part.shape == (40, 48)
    inner = np.s_[FAR:-FAR, FAR:-FAR]  # beyond its edges nothing is known of the mesh
    assert (part[inner] != whole[8:48, 16:64][inner]).mean() < 0.01
    assert part.any()


def test_a_mesh_that_moves_or_is_edited_is_drawn_again(silhouette: Silhouette) -> None:
    before = alpha(silhouette)
    assert np.array_equal(alpha(silhouette), before)
    moved = alpha(silhouette, replaced(MESH, translate=(0.6, 0.1, 0.3)))
    assert not np.array_equal(moved, before)
    assert np.array_equal(alpha(silhouette, replaced(MESH, translate=MESH.translate)), before)
    turned = alpha(silhouette, camera=replaced(CAMERA, fov=70.0))
    assert 0 < turned.sum() < before.sum()


def test_meshes_that_are_apart_each_have_their_line(silhouette: Silhouette) -> None:
    one = replaced(MESH, translate=(-0.8, 0.1, 0.3))
    other = octahedron(translate=(1.4, 0.1, 0.3))
    alone = [alpha(silhouette, mesh) for mesh in (one, other)]
    assert all(line.any() for line in alone)
    assert not (alone[0] * alone[1]).any()
    assert np.array_equal(alpha(silhouette, one, other), np.maximum(*alone))
    assert np.array_equal(alpha(silhouette, other), alone[1])


def test_another_mesh_in_the_place_of_one_has_its_own_line(silhouette: Silhouette) -> None:
    place: Any = {"rotate": (10, 20, 30), "translate": (0.2, 0.1, 0.3)}
    ball, other = ball_mesh(**place), octahedron(**place)
    assert np.allclose(ball.triangles.box, other.triangles.box)
    before = alpha(silhouette, ball)
    assert 0 < alpha(silhouette, other).sum() < before.sum()


def test_meshes_that_overlap_have_one_line_around_both(silhouette: Silhouette) -> None:
    near = ball_mesh(translate=(0.5, 0.1, 0.3))
    both = alpha(silhouette, MESH, near)
    assert both.any()
    assert (both[covered()] == 0).mean() > 0.99  # the other's line does not cross it
    assert not np.array_equal(both, alpha(silhouette))


def test_behind_the_camera_and_around_it_there_is_no_line(silhouette: Silhouette) -> None:
    away = replaced(CAMERA, look_at=(0.4, 0.7, 9.0))
    assert not alpha(silhouette, camera=away).any()
    within = Camera(position=(0.2, 0.1, 0.3), look_at=(0.2, 0.1, -1.0), fov=50.0)
    assert not alpha(silhouette, camera=within).any()
