"""Moving the camera: pure functions, in closed form."""

import math

import numpy as np
import pytest

from glrt.scene import Camera
from glrt.ui import orbit

EYE = Camera(position=(1.0, 2.0, 5.0), look_at=(0.5, 1.0, -1.0), fov=40.0)
PIVOT = (0.2, 0.5, -0.7)


def direction(camera: Camera) -> orbit.Array:
    return orbit.axes(camera)[2]


def test_axes_are_orthonormal_and_right_handed() -> None:
    right, up, forward = orbit.axes(EYE)
    assert np.allclose(np.array([right, up, forward]) @ np.array([right, up, forward]).T, np.eye(3))
    assert np.allclose(np.cross(right, up), -forward)
    assert up[1] > 0


@pytest.mark.parametrize(("yaw", "pitch"), [(30.0, 0.0), (-12.0, 7.0), (200.0, -20.0)])
def test_orbit_keeps_the_distance_to_the_pivot_and_its_place_in_the_frame(
    yaw: float, pitch: float
) -> None:
    after = orbit.orbited(EYE, PIVOT, yaw, pitch)
    assert orbit.distance_to(after, PIVOT) == pytest.approx(orbit.distance_to(EYE, PIVOT))
    for before_axis, axis in zip(orbit.axes(EYE), orbit.axes(after), strict=True):
        before = np.dot(np.subtract(PIVOT, EYE.position), before_axis)
        assert np.dot(np.subtract(PIVOT, after.position), axis) == pytest.approx(before)
    assert after.fov == EYE.fov


def test_yaw_of_a_full_turn_comes_back() -> None:
    after = orbit.orbited(EYE, PIVOT, 360.0, 0.0)
    assert np.allclose(after.position, EYE.position)
    assert np.allclose(after.look_at, EYE.look_at)


@pytest.mark.parametrize("pitch", [-500.0, 500.0])
def test_poles_are_not_crossed(pitch: float) -> None:
    for after in (orbit.orbited(EYE, PIVOT, 0, pitch), orbit.looked(EYE, 0, pitch)):
        elevation = math.degrees(math.asin(direction(after)[1]))
        assert abs(elevation) == pytest.approx(90 - orbit.POLE)
        assert np.dot(orbit.axes(after)[0], orbit.axes(EYE)[0]) == pytest.approx(1)


def test_a_camera_beyond_the_pole_limit_can_come_back() -> None:
    steep = Camera(position=(0.0, 5.0, 0.01), look_at=(0.0, 0.0, 0.0))
    assert direction(orbit.looked(steep, 0, 10))[1] > direction(steep)[1]
    assert np.allclose(direction(orbit.looked(steep, 0, -10)), direction(steep))


def test_looking_around_keeps_the_position_and_turns_by_the_angle() -> None:
    level = Camera(position=(1.0, 2.0, 3.0), look_at=(1.0, 2.0, -1.0))
    after = orbit.looked(level, -25.0, 0.0)
    assert after.position == level.position
    turned = math.degrees(math.acos(np.dot(direction(after), direction(level))))
    assert turned == pytest.approx(25)
    assert direction(after)[0] > 0, "a negative yaw turns to the right"


def test_moving_shifts_eye_and_target_along_the_axes() -> None:
    after = orbit.moved(EYE, 0.3, -0.2, 1.5)
    step = np.subtract(after.position, EYE.position)
    assert np.allclose(np.array(orbit.axes(EYE)) @ step, [0.3, -0.2, 1.5])
    assert np.allclose(after.view, EYE.view)


def test_dolly_shrinks_the_distance_and_never_arrives() -> None:
    after = orbit.dollied(EYE, PIVOT, 3)
    expected = orbit.WHEEL**3 * orbit.distance_to(EYE, PIVOT)
    assert orbit.distance_to(after, PIVOT) == pytest.approx(expected)
    assert np.allclose(direction(after), direction(EYE))
    back = orbit.dollied(after, PIVOT, -3)
    assert np.allclose(back.position, EYE.position)
    assert orbit.distance_to(orbit.dollied(EYE, PIVOT, 200), PIVOT) > 0


def test_a_framed_ball_touches_the_edge_of_the_frame() -> None:
    after = orbit.framed(EYE, (3.0, -1.0, 2.0), 0.7)
    assert after.look_at == (3.0, -1.0, 2.0)
    angle = math.degrees(math.asin(0.7 / orbit.distance_to(after, after.look_at)))
    assert angle == pytest.approx(after.fov / 2)
    assert np.allclose(direction(after), direction(EYE))


def test_depth_is_measured_along_the_view() -> None:
    right, up, forward = orbit.axes(EYE)
    point = np.array(EYE.position) + 3 * forward + 2 * right - up
    assert orbit.depth_of(EYE, (point[0], point[1], point[2])) == pytest.approx(3)
