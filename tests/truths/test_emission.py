"""Spots, lamps of one side, and surfaces that reflect and emit: closed forms, or the bits of a
scene that says the same."""

import math
from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.scene.lights.cone import Cone
from glrt.scene.scene import Scene
from tests.support.builders import MATTE, disk, lamp, plane, quad, room_of_planes, scene_of, sphere
from tests.support.images import same_bits
from tests.support.meshes import mesh
from tests.support.renders import (
    METHODS,
    assert_agree,
    assert_mean,
    rendered,
    same,
    whole,
)

FLOOR = plane([0, 0, 0], [0, 1, 0], "floor")
DOWN = {"position": [0, 1, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 0.01}
ABOVE = {"position": [0, 3, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 60}
FRONT = {"emission_side": "front"}
TRIANGLE = np.array([[-1.0, 2, -1], [1, 2, -1], [0, 2, 1]]), np.array([[0, 1, 2]])
MODELS = ("phong", "blinn", "whitted", "cook")


def spot(cone: dict[str, Any], radiance: float = 2.0) -> dict[str, Any]:
    return lamp(radiance, cone=cone)


def under(lamps: list[dict[str, Any]], material: dict[str, Any], camera: Any = DOWN) -> Scene:
    return scene_of([FLOOR, *lamps], {"floor": MATTE, "lamp": material}, camera)


LAMPS = {
    "sphere": sphere([0.4, 2, 0.1], 0.3, "lamp"),
    "quad": quad([0, 2, 0], [0.5, 0, 0], [0, 0.1, 0.5], "lamp"),
    "disk": disk([0.4, 2, 0.1], [0.3, 1, 0], 0.3, "lamp"),
    "mesh": mesh(TRIANGLE, "lamp", smooth=False),
}


# --- cones ---------------------------------------------------------------------------------


@pytest.mark.slow_cases(
    "sphere-nee",
    "sphere-phong",
    "sphere-whitted",
    "sphere-cook",
    "quad-whitted",
    "disk-phong",
    "disk-whitted",
    *("disk-naive", "disk-nee", "quad-naive", "quad-nee"),
)
@pytest.mark.slow_cases("mesh-naive")
@pytest.mark.slow_cases("mesh-nee", "mesh-mis", "mesh-whitted", "mesh-cook")
@pytest.mark.parametrize("method", [*METHODS, *MODELS])
@pytest.mark.parametrize("kind", LAMPS)
def test_inside_the_inner_angle_a_spot_is_the_lamp_to_the_bit(
    context: Context, kind: str, method: str
) -> None:
    cone = {"axis": [-0.1, -1, 0], "inner": 60, "outer": 80}
    image = rendered(under([LAMPS[kind]], spot(cone)), context, 32, method=method, bounces=1)
    plain = rendered(under([LAMPS[kind]], lamp(2.0)), context, 32, method=method, bounces=1)
    assert same(image, plain)
    assert method == "naive" or image.radiance.mean() > 0


@pytest.mark.slow_cases("mesh-naive", "disk-naive", "disk-nee", "quad-naive", "quad-nee")
@pytest.mark.slow_cases("mesh-nee", "mesh-mis", "mesh-whitted", "mesh-cook")
@pytest.mark.parametrize("method", [*METHODS, *MODELS])
@pytest.mark.parametrize("kind", LAMPS)
def test_outside_the_outer_angle_a_spot_is_dark(context: Context, kind: str, method: str) -> None:
    cone = {"axis": [0, 1, 0], "inner": 20, "outer": 60}
    scene = under([LAMPS[kind]], spot(cone))
    image = rendered(scene, context, 32, method=method, bounces=3)
    assert not image.radiance.any()


@pytest.mark.parametrize("method", ["nee", "mis", "whitted"])
@pytest.mark.parametrize("degrees", [0.0, 10.0, 19.0, 21.0, 25.0, 29.0])
def test_a_small_spot_lights_by_the_share_of_its_cone(
    context: Context, degrees: float, method: str
) -> None:
    """A ball far smaller than its distance: a / pi x Le x pi r^2 / d^2 x cos x share."""
    angle = math.radians(degrees)
    cone = Cone(axis=(math.sin(angle), -math.cos(angle), 0), inner=20, outer=30)
    ball = sphere([0, 2, 0], 1e-3, "lamp")
    scene = under([ball], spot(cone.model_dump(), 1e6))
    share = float(cone.shares(np.array([[0.0, -1.0, 0.0]]))[0])
    image = rendered(scene, context, 4, method=method, bounces=1)
    assert image.radiance.mean() == pytest.approx(0.5 * 1e6 * 1e-6 / 4 * share, rel=3e-3)


@pytest.mark.parametrize("outer", [20.0, 40.0, 80.0])
def test_a_spot_in_a_white_ball_gives_off_the_flux_of_its_cone(
    context: Context, outer: float
) -> None:
    """In an integrating sphere all light that was scattered is even: a^2 + ... of flux / (pi area).

    The wall that the camera sees is behind the lamp, where no direct light falls.
    """
    albedo, radius, radiance = 0.5, 0.02, 1e4
    cone = Cone(axis=(0, 0, 1), inner=outer / 2, outer=outer)
    wall = {"type": "lambertian", "color": [albedo] * 3}
    scene = scene_of(
        [sphere([0, 0, 0], 1, "wall"), sphere([0, 0, 0], radius, "lamp")],
        {"wall": wall, "lamp": spot(cone.model_dump(), radiance)},
        {"position": [0, 0, -0.5], "look_at": [0, 0, -1], "fov": 20},
    )
    flux = radiance * math.pi * radius**2 * cone.solid_angle
    even = flux / (math.pi * 4 * math.pi)
    truth = sum(albedo**length * even for length in range(2, 7))
    image = rendered(scene, context, 4096, method="mis", bounces=6, roulette=False)
    assert_mean(whole(image), truth, within=0.03, floor=2e-3 * truth)


def spots(count: int) -> Scene:
    """Lamps in three rows, each with a cone of its own, above a floor; none touches another."""
    materials = {"floor": MATTE}
    lamps, size = [], min(0.1, 2 / count)
    for number in range(count):
        x = 4 * (number + 0.5) / count - 2
        axis = [math.sin(7.0 * number) / 2, -1, math.cos(5.0 * number) / 2]
        name = f"lamp {number}"
        materials[name] = lamp(3.0 + number % 3, cone={"axis": axis, "inner": 10, "outer": 35})
        kind = number % 3
        if kind == 0:
            lamps.append(sphere([x, 1.5, 0], size, name))
        elif kind == 1:
            lamps.append(disk([x, 1.5, 0.5], [0.2, 1, 0], size, name))
        else:
            lamps.append(quad([x, 1.5, -0.5], [2 * size, 0, 0], [0, 0, 0.2], name) | FRONT)
    return scene_of([FLOOR, *lamps], materials, ABOVE)


@pytest.mark.slow
@pytest.mark.slow_cases("40", "7")
@pytest.mark.parametrize("count", [1, 7, 40])
def test_all_methods_see_the_same_light_of_many_spots(context: Context, count: int) -> None:
    """One is chosen always, few are weighed one by one, many by clusters and parts of them."""
    scene = spots(count)
    naive = rendered(scene, context, 32768, method="naive", bounces=2)
    for seed, method in enumerate(("nee", "mis"), start=1):
        image = rendered(scene, context, 2048, method=method, bounces=2, seed=seed)
        assert_agree(image, naive, within=0.1 if count == 1 else 0.06)


# --- one side ------------------------------------------------------------------------------


@pytest.mark.slow_cases("quad-whitted", "disk-whitted", "mesh-naive")
@pytest.mark.slow_cases("mesh-nee", "mesh-mis", "mesh-whitted", "mesh-cook")
@pytest.mark.parametrize("method", [*METHODS, *MODELS])
@pytest.mark.parametrize("kind", ["quad", "disk", "mesh"])
def test_the_front_is_the_lamp_to_the_bit_and_the_back_is_dark(
    context: Context, kind: str, method: str
) -> None:

    def picture(shape: dict[str, Any]) -> Image:
        return rendered(under([shape], lamp(2.0)), context, 64, method=method, bounces=2)

    lit = []
    for shape in (LAMPS[kind], reversed_shape(LAMPS[kind])):
        found, plain = picture(shape | FRONT), picture(shape)
        lit.append(found.radiance.any())
        assert same_bits(found.radiance, plain.radiance if lit[-1] else 0 * plain.radiance)
    assert method == "naive" or sorted(lit) == [False, True]


def reversed_shape(shape: dict[str, Any]) -> dict[str, Any]:
    if shape["shape"] == "quad":
        return shape | {"edge_u": shape["edge_v"], "edge_v": shape["edge_u"]}
    if shape["shape"] == "disk":
        return shape | {"normal": [-x for x in shape["normal"]]}
    return mesh((TRIANGLE[0], TRIANGLE[1][:, ::-1]), "lamp", smooth=False)


def test_a_quad_shines_along_its_normal(context: Context) -> None:
    """edge_u x edge_v, whichever is the longer."""
    for u, v in (([1, 0, 0], [0, 0, 3]), ([3, 0, 0], [0, 0, 1])):
        for edges, is_lit in (((u, v), True), ((v, u), False)):
            shape = quad([-0.5, 2, -0.5], *edges, "lamp") | FRONT
            for method in ("mis", "phong"):
                image = rendered(under([shape], lamp(2.0)), context, 32, method=method)
                assert image.radiance.any() == is_lit


@pytest.mark.slow
def test_one_side_of_a_smooth_mesh_is_that_of_its_facets(context: Context) -> None:
    """Shading normals do not decide what emits."""
    vertices, faces = TRIANGLE
    tilted = np.tile([0.9, -0.4, 0.0], (3, 1))  # seen from behind, where facets are from before
    for order, is_lit in ((faces, True), (faces[:, ::-1], False)):
        shape = mesh((vertices, order), "lamp", smooth=True, normals=tilted) | FRONT
        seen = {"position": [-5, 1.5, 0], "look_at": [0, 2, 0], "fov": 0.5}
        image = rendered(under([shape], lamp(2.0), seen), context, 4, bounces=0)
        assert (image.radiance == (2.0 if is_lit else 0.0)).all()


# --- surfaces that reflect and emit -----------------------------------------------------------


@pytest.mark.parametrize("method", [*METHODS, *MODELS])
def test_a_matte_surface_that_emits_is_the_lamp_of_its_colour_to_the_bit(
    context: Context, method: str
) -> None:
    color, emission = [0.2, 0.5, 0.7], [3.0, 1.0, 2.0]
    ways = (
        {"type": "light", "color": color, "emission": emission},
        {"type": "lambertian", "color": color, "emission": emission},
    )
    ball = sphere([0.4, 1, 0], 0.5, "lamp")
    first, second = (
        rendered(under([ball], way, ABOVE), context, 16, method=method) for way in ways
    )
    assert same(first, second)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("bounces", [0, 1, 5])
def test_a_room_of_mirrors_that_glow_sums_a_series(
    context: Context, method: str, bounces: int
) -> None:
    """Le (1 - c^(B+1)) / (1 - c), to the bit for c = 1/2."""
    glow = {"type": "metal", "color": [0.5] * 3, "emission": [1.0, 2.0, 4.0]}
    scene = scene_of(room_of_planes("glow"), {"glow": glow})
    image = rendered(scene, context, 4, method=method, bounces=bounces, roulette=False)
    truth = np.array([1, 2, 4], np.float32) * np.float32(2 - 2.0**-bounces)
    assert (image.radiance == truth).all()


@pytest.mark.parametrize("method", ["nee", "mis"])
def test_glowing_rough_metal_lights_as_a_lamp_does(context: Context, method: str) -> None:
    """Where only its emission is seen: one bounce, at the floor."""
    ball = sphere([0.4, 2, 0.1], 0.3, "lamp")
    glow = {"type": "metal", "color": [0.9] * 3, "roughness": 0.4, "emission": [2.0] * 3}
    image = rendered(under([ball], glow), context, 16, method=method, bounces=1)
    assert same(image, rendered(under([ball], lamp(2.0)), context, 16, method=method, bounces=1))
