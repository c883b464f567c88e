"""Objects that move take their history along; what stays keeps its bits."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.analysis.motion.playing import read_texture
from glrt.gpu.context import Context
from glrt.rendering.history.motion import MOST, moved_objects, table_of
from glrt.rendering.history.reprojection import Reprojection
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from glrt.view.viewport.transform import scaled, shifted, turned
from tests.support.builders import MATTE, box, cylinder, disk, plane, quad, scene_of, sphere
from tests.support.moving import FOV, UNLIMITED, brought, noise, samples_shown, view

SIZE = (32, 24)
PIXEL = 1.0 / SIZE[1]  # at distance 1, in scene units
CAMERA = {"position": [0.0, 0.0, 1.0], "look_at": [0.0, 0.0, 0.0], "fov": FOV}
TURN = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
STEP = np.array([0.3, -0.2, 0.5])
Array = NDArray[Any]


def one(shape: Any, **camera: Any) -> Scene:
    return scene_of([shape], {"matte": MATTE}, {**CAMERA, **camera})


def before_and_after(shape: dict[str, Any]) -> tuple[Scene, Scene]:
    """A shape, and the same turned, grown by a half and shifted."""
    before = one(shape)
    old: Shape = before.objects[0]
    new = shifted(scaled(turned(old, TURN), 1.5), STEP)
    return before, before.model_copy(update={"objects": (new,)})


# --- the map between two places of a shape --------------------------------------------------------

BOX = box([-1, 0, 2], [1, 3, 2.5], "matte", (10, 20, 30))
SKEW = quad([1, 2, 3], [1, 0, 0.5], [0.3, 2, 0], "matte")
DISK = disk([1, 2, 3], [1, 2, -2], 0.7, "matte")
CYLINDER = cylinder([0, 1, 0], [1, 1, 2], 0.4, "matte")


@pytest.mark.parametrize("shape", [BOX, SKEW], ids=["box", "quad"])
def test_corners_of_a_moved_shape_map_to_those_before(shape: dict[str, Any]) -> None:
    before, now = before_and_after(shape)
    ((number, to_before),) = moved_objects(now, before)
    corners = now.objects[0].polygons.reshape(-1, 3)
    found = corners @ to_before[:, :3].T + to_before[:, 3]
    truth = before.objects[0].polygons.reshape(-1, 3)
    assert number == 0
    np.testing.assert_allclose(found, truth, atol=1e-5)


@pytest.mark.parametrize("shape", [DISK, CYLINDER], ids=["disk", "cylinder"])
def test_a_moved_round_shape_maps_to_itself_up_to_a_turn_about_its_axis(
    shape: dict[str, Any],
) -> None:
    before, now = before_and_after(shape)
    (moved,) = moved_objects(now, before)
    linear = moved.to_before[:, :3]
    new, old = now.objects[0].placement, before.objects[0].placement
    np.testing.assert_allclose(linear @ new[:, :3], old[:, :3], atol=1e-6)
    np.testing.assert_allclose(linear @ linear.T, np.eye(3) / 1.5**2, atol=1e-6)
    lengths = np.linalg.norm(old[:, :3], axis=0)
    assert lengths[0] == pytest.approx(shape["radius"])
    assert old[:, 3] == pytest.approx(before.objects[0].middle)


def test_a_ball_and_a_plane_map_by_what_moves_them() -> None:
    before, now = one(sphere([1, 2, 3], 0.5, "matte")), one(sphere([2, 2, 3], 0.25, "matte"))
    (moved,) = moved_objects(now, before)
    assert moved.to_before @ [2.25, 2, 3, 1] == pytest.approx([1.5, 2, 3])
    before, now = (
        one(plane([0, 0, 0], [0, 1, 0], "matte")),
        one(plane([0, 1, 0], [0, 2, 0], "matte")),
    )
    (moved,) = moved_objects(now, before)
    assert moved.to_before @ [5, 1, -3, 1] == pytest.approx([5, 0, -3])


def test_what_stays_and_what_has_another_material_is_not_in_the_table() -> None:
    before = scene_of(
        [plane([0, 0, 0], [0, 1, 0], "matte"), sphere([0, 1, 0], 0.5, "matte")], {"matte": MATTE}
    )
    same = before.model_copy(update={"objects": tuple(o.model_copy() for o in before.objects)})
    assert moved_objects(same, before) == []
    kept, ball = before.objects
    moved = before.model_copy(update={"objects": (kept, shifted(ball, STEP))})
    (found,) = moved_objects(moved, before)
    row = table_of([found], np.array([1.0, 0, 0]), np.array([0, 0, 2.0]))[0]
    place = np.array([0.25, 0.5, 1.0, 1.0])  # from the eye, which was elsewhere
    assert row[0, 0] == 1 + found.number
    assert row[1:4] @ place == pytest.approx(place[:3] + np.array([1, 0, -2]) - STEP)


def test_more_objects_in_motion_than_rows_are_taken_for_still_ones() -> None:
    balls = tuple(sphere([x, 0, 0], 0.1, "matte") for x in range(MOST + 1))
    before, now = (
        scene_of([{**ball, "radius": radius} for ball in balls], {"matte": MATTE})
        for radius in (0.1, 0.2)
    )
    assert moved_objects(now, before) == []


# --- history --------------------------------------------------------------------------------------


def test_a_shifted_quad_brings_every_bit_and_the_wall_behind_it_stays(context: Context) -> None:
    """The quad goes right by 4 pixels, and uncovers a band of the wall."""

    def scene(aside: float) -> Scene:
        near = quad([-3 + aside, -3, 0.5], [3, 0, 0], [0, 6, 0], "matte")
        return scene_of([plane([0, 0, 0], [0, 0, 1], "matte"), near], {"matte": MATTE}, CAMERA)

    history, middle = noise(SIZE), SIZE[0] // 2
    found = brought(scene(0.0), scene(-2 * PIXEL), history, context)
    left = slice(0, middle - 5)
    assert np.array_equal(found[:, left], history[:, 4 : middle - 1])
    assert (found[:, middle - 4 : middle, 3] == 0).all()
    right = slice(middle + 1, None)
    assert np.array_equal(found[:, right], history[:, right])


def test_history_lies_on_a_quad_that_turns_grows_and_comes_nearer(context: Context) -> None:
    """The history is linear in the coordinates of the quad itself, so that all of it is known."""
    shape = quad([-0.5, -0.4, 0], [0.9, 0.1, 0], [0, 0.8, 0.1], "matte")
    before = one(shape)
    angle = np.radians(40)
    turn = np.array(
        [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
    )
    new = shifted(scaled(turned(before.objects[0], turn), 1.1), np.array([0.05, -0.03, 0.1]))
    now = before.model_copy(update={"objects": (new,)})
    with view(before, context, (96, 72)) as old, view(now, context, (96, 72)) as here:
        reprojection = Reprojection(context.gl, UNLIMITED)
        with context.gl:
            own = [_own_coordinates(it.scene, read_texture(it.position)) for it in (old, here)]
            is_quad = read_texture(here.position)[..., 3] > 0
            known = np.ones((72, 96, 4), np.float32)
            known[..., :3] = own[0]
            texture = context.gl.texture((96, 72), 4, known.tobytes(), dtype="f4")
            found = read_texture(reprojection.bring(here, old, texture)).copy()
            texture.release()
            reprojection.release()
    has = (found[..., 3] > 0) & is_quad
    assert has.sum() > 0.95 * is_quad.sum() > 1000
    inner = has & (np.abs(own[1][..., :2]) < 0.43).all(axis=-1)  # with neighbours all around
    np.testing.assert_allclose(found[..., :3][inner], own[1][inner], atol=2e-4)


def _own_coordinates(scene: Scene | None, position: Array) -> Array:
    """Coordinates in the frame of the only object, (H, W, 3), of surfaces relative to the eye."""
    assert scene
    frame = scene.objects[0].placement
    points = position[..., :3] + np.array(scene.camera.position) - frame[:, 3]
    found: Array = points @ np.linalg.inv(frame[:, :3]).T
    return found


@pytest.mark.parametrize("mode", ["reproject", "taa", "wrls"])
def test_a_moving_ball_keeps_its_samples(context: Context, mode: Any) -> None:
    """Five frames of one sample: in its middle the picture stands for more than the last one."""
    scenes = [one(sphere([n * 3 * PIXEL, 0, 0], 0.3, "matte")) for n in range(-4, 1)]
    counts = samples_shown(scenes, mode, SIZE, context)
    middle = counts[10:14, 14:18]
    assert (middle > 1.5).all()
