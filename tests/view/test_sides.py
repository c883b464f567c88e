"""Views of a whole scene from its sides, and cameras of its files."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from glrt.image.sources import load
from glrt.scene.camera import Camera
from glrt.view.edits.file_camera import cameras_of
from glrt.view.viewport.orbit import axes
from glrt.view.viewport.pick import first_along, ray_through
from glrt.view.viewport.sides import SIDES, Ball, ball_of, seen_from
from tests.scene.test_file_cameras import FOV, cameras
from tests.support.builders import box, disk, plane, scene_of, sphere
from tests.support.gltf_files import Builder, square
from tests.support.meshes import mesh, quads

MATTE = {"m": {"type": "lambertian", "color": [0.5, 0.5, 0.5]}}
SQUARE = 1.0  # width over height


def test_the_ball_is_around_what_is_shown_and_ends() -> None:
    hidden = {**sphere([50, 0, 0], 1, "m"), "hidden": True}
    ground = plane([0, -1, 0], [0, 1, 0], "m")
    scene = scene_of([sphere([0, 0, 0], 1, "m"), box([2, -1, -1], [5, 1, 1], "m")], MATTE)
    more = scene_of(
        [sphere([0, 0, 0], 1, "m"), ground, hidden, box([2, -1, -1], [5, 1, 1], "m")], MATTE
    )
    expected = Ball((2.0, 0.0, 0.0), math.sqrt(3**2 + 1 + 1))
    assert ball_of(scene) == ball_of(more) == expected
    assert ball_of(scene_of([ground], MATTE)) is None


def test_a_mesh_that_is_turned_is_in_the_ball() -> None:
    """A strip along x, turned so that it lies along y from x = 4 to x = 5."""
    strip = quads([[0, 0, 0], [10, 0, 0], [0, 1, 0]])
    turned = mesh(strip, "m", rotate=[0, 0, 90], translate=[5, 0, 0])
    ball = ball_of(scene_of([turned], MATTE))
    assert ball
    np.testing.assert_allclose(ball.center, [4.5, 5, 0], atol=1e-12)
    assert ball.radius == pytest.approx(math.hypot(10, 1) / 2)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("aspect", [1.0, 0.4, 3.0])
def test_a_ball_just_fits_into_the_frame_from_each_side(side: str, aspect: float) -> None:
    camera = Camera(position=(7, 8, 9), look_at=(1, 1, 1), fov=40, focus_distance=3)
    ball = Ball((1.0, 2.0, 3.0), 0.5)
    seen = seen_from(camera, ball, side, aspect)
    scene = scene_of([sphere(ball.center, 0.5, "m")], MATTE).model_copy(update={"camera": seen})
    short = (0.5, 0.0) if aspect >= 1 else (0.0, 0.5)  # to the nearest edge, of the middle

    def is_met(share: float) -> bool:
        x, y = 0.5 + share * short[1], 0.5 + share * short[0]
        return first_along(scene, *ray_through(seen, aspect, x, y)) is not None

    assert is_met(0.99)
    assert not is_met(1.01)
    np.testing.assert_allclose(-axes(seen)[2], SIDES[side], atol=1e-6)
    assert (seen.fov, seen.focus_distance) == (40, None)


def test_from_above_right_is_x_and_up_is_away_as_on_a_map() -> None:
    camera = Camera(position=(7, 8, 9), look_at=(1, 1, 1), up=(1, 0, 0))
    for side, away in (("top", -1.0), ("bottom", 1.0)):
        right, up, _ = axes(seen_from(camera, Ball((0.0, 0.0, 0.0), 1.0), side, SQUARE))
        np.testing.assert_allclose(right, [1, 0, 0], atol=1e-6)
        np.testing.assert_allclose(up, [0, 0, away], atol=0.01)


def test_what_has_no_size_is_seen_all_the_same() -> None:
    camera = Camera(position=(7, 8, 9), look_at=(1, 1, 1))
    flat = scene_of([disk([0, 0, 0], [0, 1, 0], 1e-15, "m")], MATTE)
    ball = ball_of(flat)
    assert ball
    assert seen_from(camera, ball, "front", SQUARE).position[2] > 0


def test_cameras_of_a_file_are_listed_by_their_nodes(tmp_path: Path) -> None:
    (tmp_path / "set.glb").write_bytes(cameras().glb())
    scene = load(tmp_path / "set.glb")
    found = cameras_of(scene)
    assert list(found) == ["still", "crane", "5", "6"], "twins have their numbers"
    assert found["still"].position == (1, 2, 3)
    assert found["still"].fov == pytest.approx(FOV)
    assert found["crane"].position == (9, 9, 12)
    assert load("cornell").camera not in cameras_of(load("cornell")).values()


def test_cameras_of_two_files_are_told_apart(tmp_path: Path) -> None:
    for name in ("a.glb", "b.glb"):
        (tmp_path / name).write_bytes(cameras().glb())
    text = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[background]\ncolor = [1, 1, 1]\n"
    objects = "".join(f'[[objects]]\nshape = "mesh"\nfile = "{name}.glb"\n' for name in "ab")
    (tmp_path / "two.toml").write_text(text + objects)
    found = cameras_of(load(tmp_path / "two.toml"))
    assert [name for name in found if "still" in name] == ["a.glb: still", "b.glb: still"]


def test_a_file_that_is_gone_or_has_no_camera_has_none(tmp_path: Path) -> None:
    builder: Any = Builder()
    builder.shown(square(builder))
    (tmp_path / "plain.glb").write_bytes(builder.glb())
    assert cameras_of(load(tmp_path / "plain.glb")) == {}
    (tmp_path / "set.glb").write_bytes(cameras().glb())
    scene = load(tmp_path / "set.glb")
    (tmp_path / "set.glb").unlink()
    assert cameras_of(scene) == {}
