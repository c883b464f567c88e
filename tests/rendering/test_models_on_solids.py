"""The models before path tracing on disks, boxes and cylinders, against closed forms in float64."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from tests.support.builders import box, cylinder, disk, glass, lamp, plane, quad, scene_of, sphere
from tests.support.numerics import Array
from tests.support.renders import rendered

ALBEDO, RADIANCE, RADIUS = 0.5, 60.0, 0.05
MATERIALS: dict[str, dict[str, Any]] = {
    "white": {"type": "lambertian", "color": [ALBEDO] * 3},
    "brass": {"type": "metal", "color": [0.9, 0.7, 0.3], "roughness": 0.5},
    "mirror": {"type": "metal", "color": [0.8, 0.6, 0.4]},
    "glass": glass(),
    "lamp": lamp(RADIANCE),
}
LAMP = np.array([0.6, 1.1, -1.2])
BULB = sphere(LAMP, RADIUS, "lamp")
THINGS = {
    "disk": disk([0, 0, -3], [0.3, 1, 0.9], 0.8, "white"),
    "box": box([-0.6, -0.5, -3.5], [0.5, 0.4, -2.6], "white", [20, 30, 0]),
    "cylinder": cylinder([-0.5, -0.4, -3], [0.4, 0.5, -2.8], 0.5, "white"),
    "tube": cylinder([-0.5, -0.4, -3], [0.4, 0.5, -2.8], 0.5, "white", capped=False),
}
SIZE, FOV = 64, 36.0
FLOOR = -0.9


@pytest.mark.slow
@pytest.mark.slow_cases("blinn", "whitted")
@pytest.mark.parametrize("method", ["phong", "blinn", "whitted", "cook"])
def test_faces_of_one_plane_are_shaded_alike(context: Context, method: str) -> None:
    """A box, a disk and a cap in the place of a quad, of each material."""
    faces: dict[str, Callable[[str], dict[str, Any]]] = {
        "box": lambda m: box([-9, -9, -4], [9, 9, -3], m),
        "disk": lambda m: disk([0, 0, -3], [0, 0, 1], 9, m),
        "cylinder": lambda m: cylinder([0, 0, -4], [0, 0, -3], 9, m),
    }
    for material in ("white", "brass", "mirror"):
        wall = quad([-9, -9, -3], [18, 0, 0], [0, 18, 0], material)
        truth = picture(context, [wall], method)
        assert truth.max() > 0
        for name, face in faces.items():
            found = picture(context, [face(material)], method)
            note = f"{name} of {material}"
            assert_allclose(found, truth, rtol=2e-3, atol=1e-4, err_msg=note)


def picture(context: Context, objects: list[dict[str, Any]], method: str) -> Array:
    """The picture with the lamp, and with a sky for mirrors to show."""
    scene = scene_of([*objects, BULB], MATERIALS, {"fov": FOV}, background=SKY)
    size: dict[str, Any] = {"width": 24, "height": 24, "bounces": 3}
    return rendered(scene, context, 2, method=method, **size).radiance


SKY = {"bottom": [0.1, 0.1, 0.2], "top": [0.3, 0.4, 0.6]}


@pytest.mark.slow_cases(
    "phong-cylinder",
    "phong-tube",
    "blinn-cylinder",
    "blinn-tube",
    "whitted-cylinder",
    "whitted-tube",
)
@pytest.mark.parametrize("name", THINGS)
@pytest.mark.parametrize("method", ["phong", "blinn", "whitted"])
def test_matte_solids_have_the_light_of_a_point(context: Context, method: str, name: str) -> None:
    """Albedo / pi times cosine over distance squared times the intensity."""
    scene = scene_of([THINGS[name], BULB], MATERIALS, {"fov": FOV})
    size: dict[str, Any] = {"width": SIZE, "height": SIZE, "bounces": 1}
    found = rendered(scene, context, 16, method=method, **size).radiance[..., 0]
    exact = np.array([matte_light(scene.objects[0], d) for d in pixel_directions()])
    exact = np.nan_to_num(exact).reshape(SIZE, SIZE)
    smooth = smooth_part(exact)
    assert smooth.sum() > 60
    if method == "whitted" and name == "tube":
        smooth &= found > 0  # its inside is in shadow: the next test
        assert smooth.sum() > 60
    assert_allclose(found[smooth], exact[smooth], rtol=0.03)


def pixel_directions() -> Array:
    """The directions through the centres of the pixels, (n, 3), row by row."""
    across = (2 * (np.arange(SIZE) + 0.5) / SIZE - 1) * math.tan(math.radians(FOV / 2))
    grid = [[x, -y, -1.0] for y in across for x in across]
    directions = np.array(grid)
    unit: Array = directions / np.linalg.norm(directions, axis=1)[:, None]
    return unit


def smooth_part(exact: Array) -> Array:
    """Where the light of a pixel is that of its neighbours within 10 %."""
    near = [np.roll(exact, shift, axis) for shift in (-1, 1) for axis in (0, 1)]
    smooth: Array = (exact > 0.05 * exact.max()) & np.all(
        [np.abs(other - exact) < 0.1 * exact for other in near], axis=0
    )
    return smooth


def matte_light(shape: Shape, direction: Array) -> float:
    """0 where the ray misses, or sees a side that is turned away from the lamp."""
    distance = distance_to(shape, np.zeros(3), direction)
    if not math.isfinite(distance):
        return 0.0
    point = distance * direction
    normal = normal_by_distances(shape, direction)
    normal = -normal if normal @ direction > 0 else normal
    to_lamp = LAMP - point
    apart = float(np.linalg.norm(to_lamp))
    cosine = max(float(normal @ to_lamp) / apart, 0.0)
    intensity = math.pi * RADIUS**2 * RADIANCE
    return ALBEDO / math.pi * intensity * cosine / apart**2


def distance_to(shape: Shape, origin: Array, direction: Array) -> float:
    with np.errstate(all="ignore"):
        return float(type(shape).distances(np.array([shape.row]), origin, direction)[0])


def normal_by_distances(shape: Shape, direction: Array) -> Array:
    """The normal from the distances of three rays close together."""
    step = 1e-5
    points = []
    for offset in ([0, 0, 0], [step, 0, 0], [0, step, 0]):
        aim = direction + np.array(offset)
        aim = aim / np.linalg.norm(aim)
        points.append(distance_to(shape, np.zeros(3), aim) * aim)
    if not np.isfinite(points).all():
        return np.full(3, np.nan)
    normal = np.cross(points[1] - points[0], points[2] - points[0])
    unit: Array = normal / np.linalg.norm(normal)
    return unit


@pytest.mark.slow_cases("cylinder", "tube")
@pytest.mark.parametrize("name", THINGS)
def test_solids_cast_the_shadow_of_a_point(context: Context, name: str) -> None:
    """All floor pixels wholly inside the shadow are dark, others are not; phong has no shadows."""
    floor = plane([0, FLOOR, 0], [0, 1, 0], "white")
    camera = {"fov": FOV, "position": [0, 0, 0], "look_at": [0, -0.3, -1]}
    scene = scene_of([THINGS[name], BULB, floor], MATERIALS, camera)
    size: dict[str, Any] = {"width": SIZE, "height": SIZE, "bounces": 1}
    dark = rendered(scene, context, 1, method="whitted", **size).radiance[..., 0] == 0
    assert (rendered(scene, context, 1, method="phong", **size).radiance[..., 0] > 0).mean() > 0.6
    state = np.array([shadow_state(scene, row, column) for row in ROWS for column in ROWS])
    expected = state.reshape(len(ROWS), len(ROWS))
    found = dark[np.ix_(ROWS, ROWS)]
    inside, outside = expected == 1, expected == 0
    assert inside.sum() > 30
    assert outside.sum() > 300
    assert found[inside].all()
    assert not found[outside].any()


ROWS = range(0, SIZE, 2)
CORNERS = [(0.5, 0.5), (0, 0), (0, 1), (1, 0), (1, 1)]


def shadow_state(scene: Scene, row: int, column: int) -> float:
    """1 where all corners of a pixel see the floor in shadow, 0 where in light, else NaN."""
    half = math.tan(math.radians(FOV / 2))
    forward = np.array(scene.camera.view) / np.linalg.norm(scene.camera.view)
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    states = set()
    for down, along in CORNERS:
        x, y = (2 * (column + along) / SIZE - 1) * half, (1 - 2 * (row + down) / SIZE) * half
        aim = forward + x * right + y * up
        aim /= np.linalg.norm(aim)
        if aim[1] >= 0:
            return math.nan
        point = FLOOR / aim[1] * aim
        if distance_to(scene.objects[0], np.zeros(3), aim) < np.linalg.norm(point):
            return math.nan
        to_lamp = LAMP - point
        apart = float(np.linalg.norm(to_lamp))
        states.add(distance_to(scene.objects[0], point, to_lamp / apart) < apart)
    return float(states.pop()) if len(states) == 1 else math.nan
