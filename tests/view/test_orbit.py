"""Moving the camera: pure functions, in closed form."""

import math
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from glrt.core.errors import GlrtError, UsageError
from glrt.scene.camera import Camera
from glrt.scene.values import LARGEST, SMALLEST
from glrt.view.viewport import orbit

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


MOTIONS: dict[str, Callable[[Camera], Camera]] = {
    "the wheel, inwards": lambda camera: orbit.dollied(camera, camera.look_at, 5.0),
    "the wheel, to a point on a wall": lambda camera: orbit.dollied(camera, PIVOT, 1.0),
    "the wheel, outwards": lambda camera: orbit.dollied(camera, PIVOT, -5.0),
    "steps": lambda camera: orbit.moved(camera, 0.0, 0.0, 0.1 * orbit.distance_to(camera, PIVOT)),
    "steps aside": lambda camera: orbit.moved(camera, orbit.distance_to(camera, PIVOT), 0.0, 0.0),
}


@pytest.mark.parametrize("motion", MOTIONS)
def test_a_motion_without_end_stops_and_the_camera_can_come_back(motion: str) -> None:
    camera, steps = EYE, 0
    with suppress(UsageError):
        while steps < 5000:
            camera, steps = MOTIONS[motion](camera), steps + 1
    assert 30 < steps < 1000, "far, but not for ever"
    assert math.dist(direction(camera), direction(EYE)) < 1e-4
    clicks = 1.0 if math.dist(camera.position, PIVOT) > 1e3 else -1.0
    for _ in range(100):
        camera = orbit.looked(orbit.dollied(camera, PIVOT, clicks), 1.0, 0.0)
        camera = orbit.looked(camera, -1.0, 0.0)
    assert math.dist(direction(camera), direction(EYE)) < 1e-4


def test_a_wheel_that_spins_freely_counts_no_further_than_most_clicks() -> None:
    far = orbit.dollied(EYE, PIVOT, -1e300)
    assert far == orbit.dollied(EYE, PIVOT, -orbit.MOST_CLICKS)
    assert orbit.distance_to(far, PIVOT) > 1e4 * orbit.distance_to(EYE, PIVOT)


@pytest.mark.parametrize("radius", [0.9 * LARGEST, SMALLEST])
def test_what_cannot_be_framed_is_reported(radius: float) -> None:
    with pytest.raises(UsageError):
        orbit.framed(EYE, (3.0, -1.0, 2.0), radius)


SIZES = st.floats(-15.0, 15.0).map(lambda power: 10.0**power)
COORDINATES = st.one_of(
    st.sampled_from([0.0, 1.0, -1.0, LARGEST, -LARGEST, SMALLEST]),
    st.floats(-LARGEST, LARGEST),
    st.builds(lambda sign, size: sign * size, st.sampled_from([-1.0, 1.0]), SIZES),
)
VECTORS = st.tuples(COORDINATES, COORDINATES, COORDINATES)
ANY = st.floats(allow_nan=True, allow_infinity=True)
FINITE = st.floats(allow_nan=False, allow_infinity=False)


@st.composite
def cameras(draw: st.DrawFn) -> Camera | None:
    """Any that is valid; None for a draw that is not."""
    fov = st.one_of(st.floats(0, 180, exclude_min=True, exclude_max=True), st.just(5e-324))
    with suppress(ValueError):
        return Camera(
            position=draw(VECTORS), look_at=draw(VECTORS), up=draw(VECTORS), fov=draw(fov)
        )
    return None


@st.composite
def motions(draw: st.DrawFn) -> partial[Camera]:
    """One of the functions that move a camera, with whatever a window may call it with."""
    kinds: dict[Any, tuple[st.SearchStrategy[Any], ...]] = {
        orbit.orbited: (VECTORS, FINITE, FINITE),
        orbit.looked: (FINITE, FINITE),
        orbit.moved: (ANY, ANY, ANY),
        orbit.dollied: (VECTORS, ANY),
        orbit.framed: (VECTORS, SIZES),
    }
    motion = draw(st.sampled_from(list(kinds)))
    how = [draw(part) for part in kinds[motion]]
    return partial(lambda camera, motion, how: motion(camera, *how), motion=motion, how=how)


@pytest.mark.slow
@settings(max_examples=300, derandomize=True, deadline=None, database=None)
@given(cameras(), st.lists(motions(), min_size=1, max_size=4))
def test_no_motion_of_any_camera_raises_what_the_window_does_not_catch(
    camera: Camera | None, steps: list[partial[Camera]]
) -> None:
    for step in steps if camera else ():
        with suppress(GlrtError), np.errstate(all="ignore"):
            camera = step(camera)
        assert camera
        assert np.isfinite(orbit.axes(camera)).all()
