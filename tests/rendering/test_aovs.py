"""AOVs in closed form: what stands before the camera is known, often to the last bit."""

import math
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.aovs import AovImage
from glrt.scene.scene import Scene
from tests.support.alarms import assert_near
from tests.support.aov_scenes import MATERIALS, PAINT, heap, world
from tests.support.builders import plane, quad, sphere
from tests.support.first_hits import assert_mean_is, gathered, hits_of_centers
from tests.support.numerics import Array
from tests.support.renders import SAMPLERS

SIDE = 8  # pixels along an edge; the picture reaches from -1 to 1 at distance 1


def wall(kind: str, distance: float) -> dict[str, Any]:
    """All that the camera sees; of quads and planes either side."""
    half = 2 * distance
    corner, across, upward = [-half, -half, -distance], [2 * half, 0, 0], [0, 2 * half, 0]
    return {
        "plane": plane([5, 5, -distance], [0, 0, 1], "paint"),
        "plane from behind": plane([5, 5, -distance], [0, 0, -1], "paint"),
        "quad": quad(corner, across, upward, "paint"),
        "quad from behind": quad(corner, upward, across, "paint"),
    }[kind]


def before_a_wall(kind: str, distance: float, **camera: Any) -> Scene:
    return world(wall(kind, distance), **camera)


def stderr_of(aov: AovImage) -> Array:
    assert aov.stderr is not None
    return aov.stderr


def counts_of(aov: AovImage) -> tuple[Array, Array]:
    assert aov.count is not None
    assert aov.observations is not None
    return aov.count, aov.observations


def pixel_centers() -> Array:
    """The centres of columns, from -1 to 1; the centres of rows are the negative."""
    places: Array = (2 * np.arange(SIDE) + 1) / SIDE - 1
    return places


# --- a wall that faces the camera ----------------------------------------------------------------


@pytest.mark.parametrize("sampler", SAMPLERS)
@pytest.mark.parametrize("kind", ["plane", "plane from behind", "quad", "quad from behind"])
def test_a_wall_before_the_camera_is_known_to_the_last_bit(
    context: Context, kind: str, sampler: str
) -> None:
    """Either side: a normal points to the viewer."""
    for distance in (7.3, 1e-3, 123456.7):
        found = gathered(before_a_wall(kind, distance), context, 32, sampler=sampler)
        assert (found["depth"].value == np.float32(distance)).all()
        assert (found["normal"].value == [0, 0, 1]).all()
        assert (found["albedo"].value == np.array(PAINT, np.float32)).all()
        assert (found["object"].value == 1).all()
        assert (found["position"].value[..., 2] == np.float32(-distance)).all()
        for name in ("depth", "normal", "albedo"):
            assert (stderr_of(found[name]) == 0).all()
            count, observations = counts_of(found[name])
            assert (count == 32).all()
            assert (observations == (2 if sampler == "sobol" else 32)).all()


def test_the_position_on_a_wall_is_linear_in_the_pixel(context: Context) -> None:
    """Its mean is that of the middle of the pixel; its spread that of even jitter."""
    distance, samples = 3.0, 1024
    found = gathered(before_a_wall("plane", distance), context, samples)["position"]
    places = distance * pixel_centers()
    truth = np.stack([*np.meshgrid(places, -places), np.full((SIDE, SIDE), -distance)], axis=-1)
    width = 2 * distance / SIDE
    assert_mean_is(found, truth, within=0.06 * width)
    for axis in (0, 1):
        variance = np.square(stderr_of(found)[..., axis], dtype=float).mean() * samples
        relative = math.sqrt(0.8 / samples) / SIDE  # of an even density, over all pixels
        assert_near(variance / (width**2 / 12), 1, relative)
    assert (stderr_of(found)[..., 2] == 0).all()


def test_a_frame_is_as_wide_as_it_has_pixels(context: Context) -> None:
    """Pixels are square: in a frame of 16 x 4 a column is as wide as a row is high."""
    found = gathered(before_a_wall("plane", 1.0), context, 256, width=16, height=4)["position"]
    x, y = np.meshgrid((np.arange(16) + 0.5) / 2 - 4, 1 - (np.arange(4) + 0.5) / 2)
    assert_mean_is(found, np.stack([x, y, -np.ones_like(x)], axis=-1), within=0.07)


# --- floors and balls ----------------------------------------------------------------------------


def test_a_floor_recedes_as_one_over_the_angle_below_the_horizon(context: Context) -> None:
    """At v below it the floor is 1/v away: from a to b the mean is ln(b/a) / (b - a)."""
    floor = world(plane([0, -1, 0], [0, -1, 0], "paint"))
    found = gathered(floor, context, 1024)
    rows = np.arange(5, SIDE)  # of the one above, the mean is infinite
    near, far = 2 * (rows + 1) / SIDE - 1, 2 * rows / SIDE - 1
    depth = np.log(near / far) / (near - far)
    assert_mean_is(found["depth"], _on_rows(rows, depth), within=0.2, where=rows)
    x = depth[:, None] * pixel_centers()
    truth = np.stack([x, -np.ones_like(x), np.broadcast_to(-depth[:, None], x.shape)], axis=-1)
    whole = np.zeros((SIDE, SIDE, 3))
    whole[rows] = truth
    assert_mean_is(found["position"], whole, within=0.25, where=rows)
    assert (found["position"].value[rows, :, 1] == -1).all()
    assert (found["normal"].value[rows] == [0, 1, 0]).all()


def _on_rows(rows: Array, values: Array) -> Array:
    """A picture whose rows have these values, and others 0."""
    picture = np.zeros((SIDE, SIDE))
    picture[rows] = values[:, None]
    return picture


def test_in_the_middle_of_a_ball_normals_point_back(context: Context) -> None:
    """The position is the radius times the way there, the normal the way back: bit for bit."""
    inside = world(sphere([0, 0, 0], 2.0, "paint"))
    found = gathered(inside, context, 1)
    assert np.array_equal(found["position"].value, -2 * found["normal"].value)
    assert np.array_equal(found["depth"].value, -found["position"].value[..., 2])
    assert (found["normal"].value[..., 2] > 0).all()
    assert (found["object"].value == 1).all()


# --- materials, and nothing ----------------------------------------------------------------------


@pytest.mark.slow
def test_every_material_has_its_albedo(context: Context) -> None:
    """Glass has 1, metal its reflectance, a lamp its own colour, which is 0 by default."""
    names = [*MATERIALS]
    places = [(-2 + 2 * (n % 3), 1 - 2 * (n // 3)) for n in range(6)]
    balls = [sphere([x, y, -5], 0.9, name) for name, (x, y) in zip(names, places, strict=True)]
    scene = world(*balls, fov=45.0)
    found = gathered(scene, context, 16, width=30, height=20)
    is_full = counts_of(found["depth"])[0] == 16
    steel, mirror = (MATERIALS[name]["color"] for name in ("steel", "mirror"))
    wanted = np.array([PAINT, [1] * 3, steel, mirror, [0] * 3, [0.5] * 3], np.float32)
    for number, albedo in enumerate(wanted, 1):
        within = is_full & (found["object"].value == number)
        assert within.sum() > 10
        assert (found["albedo"].value[within] == albedo).all(), names[number - 1]


def test_where_nothing_is_met_colour_and_normal_count_and_distances_do_not(
    context: Context,
) -> None:
    floor = world(plane([0, -1, 0], [0, 1, 0], "paint"))
    found = gathered(floor, context, 5)
    sky = slice(0, SIDE // 2)
    for aov in (found["albedo"], found["normal"]):
        assert (aov.value[sky] == 0).all()
        assert (stderr_of(aov)[sky] == 0).all()
        for counts in counts_of(aov):
            assert (counts == 5).all()
    assert (found["depth"].value[sky] == np.inf).all()
    assert (found["position"].value[sky] == 0).all()
    for aov in (found["depth"], found["position"]):
        assert np.isnan(stderr_of(aov)[sky]).all()
        for counts in counts_of(aov):
            assert (counts[sky] == 0).all()
            assert (counts[SIDE // 2 :] == 5).all()
    assert (found["object"].value[sky] == 0).all()
    assert (found["object"].value[SIDE // 2 :] == 1).all()


# --- lenses --------------------------------------------------------------------------------------


def test_the_lens_spreads_positions_and_leaves_depths(context: Context) -> None:
    """Behind the focus, at d, the lens of radius r spreads them over a disk of r |1 - d/f|."""
    distance, focus, angle, samples = 3.0, 2.0, 20.0, 1024
    scene = before_a_wall("plane", distance, defocus_angle=angle, focus_distance=focus)
    found = gathered(scene, context, samples)
    assert (found["depth"].value == 3).all()
    assert (stderr_of(found["depth"]) == 0).all()
    disk = focus * math.tan(math.radians(angle / 2)) * abs(1 - distance / focus)
    width = 2 * distance / SIDE
    places = distance * pixel_centers()
    truth = np.stack([*np.meshgrid(places, -places), np.full((SIDE, SIDE), -distance)], axis=-1)
    assert_mean_is(found["position"], truth, within=0.07 * width)
    variance = np.square(stderr_of(found["position"])[..., :2], dtype=float).mean() * samples
    assert_near(variance / (width**2 / 12 + disk**2 / 4), 1, 1 / math.sqrt(2 * samples) / SIDE)


def test_objects_are_those_behind_the_middle_of_pixel_and_lens(context: Context) -> None:
    """A wide lens blurs the picture, and not the numbers."""
    objects = [sphere([0.3, 0.2, -3], 0.7, "paint"), plane([0, 0, -5], [0, 0, 1], "paint")]
    sharp, blurred = (
        world(*objects, fov=40.0, defocus_angle=angle, focus_distance=9.0) for angle in (0.0, 30.0)
    )
    size = {"width": 16, "height": 16}
    found, other = (
        gathered(scene, context, 2, **size)["object"].value for scene in (sharp, blurred)
    )
    assert np.array_equal(found, other)
    assert np.array_equal(found, hits_of_centers(sharp, (16, 16)).object)
    assert {*np.unique(found)} == {1, 2}


# --- the numbers of objects ----------------------------------------------------------------------


def test_objects_have_their_place_in_the_scene_file(context: Context) -> None:
    """Though the kernel numbers them by kind."""
    found = gathered(heap(), context, 1, width=16, height=16)["object"].value
    assert np.array_equal(found, hits_of_centers(heap(), (16, 16)).object)
    assert {*np.unique(found)} == {0, 1, 2, 3, 4, 5, 6}
