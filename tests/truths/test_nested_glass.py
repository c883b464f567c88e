"""Glass that absorbs, thin panes, and glasses that overlap: against closed forms."""

from functools import reduce
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from tests.support.builders import (
    MATTE,
    box,
    cylinder,
    glass,
    lamp,
    plane,
    quad,
    scene_of,
    sphere,
)
from tests.support.images import same_bits
from tests.support.meshes import box as box_of_triangles
from tests.support.meshes import mesh
from tests.support.renders import METHODS, assert_agree, assert_mean, rendered, whole

COLOR = np.array([0.9, 0.5, 0.2])
DOWN = {"position": [0, 5, 0], "look_at": [0, 0, 0], "up": [0, 0, 1], "fov": 0.01}
UNDER = {"bottom": [1.0] * 3, "horizon": [0.0] * 3, "top": [0.0] * 3}  # light from below alone


def tinted(ior: float = 1.0, distance: float = 2.0, **more: Any) -> dict[str, Any]:
    """Glass that leaves COLOR of the light after a distance."""
    color = COLOR.tolist()
    return glass(ior, attenuation_color=color, attenuation_distance=distance, **more)


def slab(thickness: float, material: str, top: float = 0.0) -> dict[str, Any]:
    return box([-9, top - thickness, -9], [9, top, 9], material)


def through(things: list[Any], materials: dict[str, Any], **camera: Any) -> Scene:
    return scene_of(things, materials, {**DOWN, **camera}, background=UNDER)


def face(outer: float, inner: float) -> float:
    """Fresnel reflectance along the normal."""
    return ((outer - inner) / (outer + inner)) ** 2


def stack(iors: list[float], left: list[float]) -> float:
    """The share of light that passes flat layers, with all reflections between them.

    `iors` from one side to the other; `left`: what each of those between leaves of it.
    """

    def add(first: tuple[float, float, float], second: tuple[float, float, float]) -> Any:
        (r1, t1, b1), (r2, t2, b2) = first, second  # reflected, passed, reflected from behind
        again = 1 - b1 * r2
        return r1 + t1 * t1 * r2 / again, t1 * t2 / again, b2 + t2 * t2 * b1 / again

    faces = [face(a, b) for a, b in pairwise(iors)]
    parts = [(faces[0], 1 - faces[0], faces[0])]
    for r, share in zip(faces[1:], left, strict=True):
        parts += [(0.0, share, 0.0), (r, 1 - r, r)]
    return float(reduce(add, parts)[1])


# --- attenuation ---------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("shape", ["box", "sphere", "cylinder", "mesh"])
def test_light_is_left_as_beer_says(context: Context, method: str, shape: str) -> None:
    """Through glass of index 1, which does nothing else: no noise."""
    things = {
        "box": slab(3, "glass"),
        "sphere": sphere([0, 0, 0], 1.5, "glass"),
        "cylinder": cylinder([0, -1.5, 0], [0, 1.5, 0], 1, "glass"),
        "mesh": mesh(box_of_triangles([-1] * 3, [1] * 3), "glass", scale=1.5),
    }[shape]
    scene = through([things], {"glass": tinted()})
    found = rendered(scene, context, 4, method=method).radiance
    assert_allclose(found, np.broadcast_to(COLOR**1.5, found.shape), rtol=1e-5, atol=1e-12)


@pytest.mark.slow_cases("mesh")
@pytest.mark.parametrize("shape", ["box", "sphere", "cylinder", "mesh", "plane"])
def test_a_camera_in_glass_sees_through_what_is_before_it(context: Context, shape: str) -> None:
    """Down to a lamp in the glass, which is no face of it."""
    things = {
        "box": slab(20, "glass", top=10),
        "sphere": sphere([0, 0, 0], 10, "glass"),
        "cylinder": cylinder([0, -10, 0], [0, 10, 0], 8, "glass"),
        "mesh": mesh(box_of_triangles([-1] * 3, [1] * 3), "glass", scale=10),
        "plane": plane([0, 10, 0], [0, 1, 0], "glass"),
    }[shape]
    lit = quad([-1, -1, -1], [2, 0, 0], [0, 0, 2], "lamp")
    scene = scene_of([things, lit], {"glass": tinted(1.5), "lamp": lamp(1.0)}, DOWN)
    found = rendered(scene, context, 4, bounces=0).radiance
    assert_allclose(found, np.broadcast_to(COLOR**3, found.shape), rtol=1e-5, atol=1e-12)


def test_a_slab_of_tinted_glass_reflects_and_passes_what_the_series_says(context: Context) -> None:
    scene = through([slab(1, "glass")], {"glass": tinted(1.5, distance=1.0)})
    image = rendered(scene, context, 4096, bounces=30)
    truth = [stack([1, 1.5, 1], [left]) for left in COLOR]
    assert_mean(whole(image), truth, within=0.02, floor=1e-6)


@pytest.mark.slow
def test_lamps_in_tinted_glass_are_found_alike(context: Context) -> None:
    """A matte ball and a lamp in a ball of it, and a floor below; rough too."""
    things = [
        sphere([0, 0, 0], 1.6, "glass"),
        sphere([-0.5, 0.2, 0], 0.4, "ball"),
        sphere([0.6, 0.5, 0.3], 0.45, "lamp"),
        plane([0, -1.7, 0], [0, 1, 0], "ball"),
    ]
    camera = {"position": [0, 0.3, 5], "look_at": [0, 0, 0], "fov": 45}
    materials = {"glass": tinted(1.3, 1.0, roughness=0.4), "ball": MATTE, "lamp": lamp(6.0)}
    scene = scene_of(things, materials, camera)
    naive, nee, mis = (
        rendered(scene, context, 4096, method=method, bounces=5, seed=seed)
        for seed, method in enumerate(METHODS)
    )
    for other in (nee, mis):
        assert_agree(other, naive, within=0.12)


@pytest.mark.parametrize("k", [-10, 10])
def test_attenuation_scales_with_the_scene(context: Context, k: int) -> None:
    """Lengths times 2^k: the same bits."""

    def picture(scale: float) -> Any:
        things = [sphere([0, 0, 0], scale, "glass"), plane([0, -scale, 0], [0, 1, 0], "floor")]
        camera = {"position": [0, 0, 4 * scale], "look_at": [0, 0, 0], "fov": 40}
        materials = {"glass": tinted(1.5, scale), "floor": MATTE}
        scene = scene_of(things, materials, camera, background={"color": [1.0] * 3})
        return rendered(scene, context, 16).radiance

    assert same_bits(picture(1.0), picture(2.0**k))


# --- panes ---------------------------------------------------------------------------------


@pytest.mark.parametrize("method", METHODS)
def test_a_pane_under_an_even_sky_cannot_be_seen(context: Context, method: str) -> None:
    things = [quad([-1, -1, z], [2, 0, 0], [0, 2, 0], "pane") for z in (0, 1)]
    camera = {"position": [1, 1, 4], "look_at": [0, 0, 0], "fov": 40}
    materials = {"pane": glass(1.5, thin=True)}
    scene = scene_of(things, materials, camera, background={"color": [0.75] * 3})
    image = rendered(scene, context, 16, method=method, bounces=100)
    assert np.all(image.radiance == 0.75)


@pytest.mark.slow
def test_a_pane_passes_what_two_faces_do(context: Context) -> None:
    scene = through([quad([-9, 0, -9], [18, 0, 0], [0, 0, 18], "pane")], {"pane": glass(thin=True)})
    image = rendered(scene, context, 4096)
    assert_mean(whole(image), stack([1, 1.5, 1], [1]), within=0.01, floor=1e-6)


def test_a_pane_lets_a_picture_through_unmoved(context: Context) -> None:
    """It acts as a slab a thousandth as thick; one of its bounces stands for two or more."""
    camera = {"position": [0, 0.6, 4], "look_at": [0, 0.3, 0], "fov": 45}
    rest = [plane([0, -1, 0], [0, 1, 0], "floor"), sphere([0, 0, -1], 0.7, "floor")]
    materials = {"floor": MATTE, "pane": glass(thin=True), "slab": glass()}
    sky = {"bottom": [0.1] * 3, "top": [1.0] * 3}
    pane = quad([-2, -0.9, 0.8], [4, 0, 1], [0, 3, 0], "pane")
    sheet = box([-2.06, -0.9, 1.299], [2.06, 2.1, 1.3], "slab", rotate=(0, -14.036243, 0))
    first, second = (
        rendered(
            scene_of([*rest, thing], materials, camera, background=sky),
            context, 512, bounces=24, seed=seed,
        )
        for seed, thing in enumerate((pane, sheet))
    )  # fmt: skip
    assert_agree(first, second, within=0.02)


# --- glasses that overlap ------------------------------------------------------------------


@pytest.mark.parametrize("overlap", [0.0, 0.25, 0.9])
def test_water_in_a_glass_meets_the_glass_and_no_air(context: Context, overlap: float) -> None:
    """A slab of glass over one of water that reaches into it by any share: F15."""
    things = [slab(1, "glass"), slab(2 + overlap, "water", top=-1 + overlap)]
    materials = {
        "glass": glass(1.5, priority=2),
        "water": tinted(1.33, distance=2.0, priority=1),
    }
    if overlap == 0.0:
        things[1] = slab(2 + 1e-6, "water", top=-1 + 1e-6)
    image = rendered(through(things, materials), context, 4096, bounces=30)
    truth = [stack([1, 1.5, 1.33, 1], [1, left]) for left in COLOR]
    assert_mean(whole(image), truth, within=0.02, floor=1e-5)


@pytest.mark.slow
def test_the_higher_priority_is_there(context: Context) -> None:
    """The same slabs, with the water over the glass: it cuts the glass short."""
    things = [slab(1, "glass"), slab(2.5, "water", top=-0.5)]
    for first, second, shares in ((2, 1, (1.0, 1.0)), (1, 2, (0.5, 1.25))):
        materials = {
            "glass": tinted(1.5, distance=1.0, priority=first),
            "water": tinted(1.33, distance=2.0, priority=second),
        }
        image = rendered(through(things, materials), context, 4096, bounces=30)
        truth = [stack([1, 1.5, 1.33, 1], [c ** shares[0], c ** shares[1]]) for c in COLOR]
        assert_mean(whole(image), truth, within=0.02, floor=1e-5)


@pytest.mark.slow_cases("0.5")
@pytest.mark.parametrize("roughness", [0.0, 0.5])
def test_a_bubble_in_glass_is_one_of_the_inverse_index(context: Context, roughness: float) -> None:
    """Air of a higher priority in glass, and without priorities an `ior` of 1 / 1.5."""
    camera = {"position": [0, 0.5, 5], "look_at": [0, 0, 0], "fov": 40}
    floor = plane([0, -1.6, 0], [0, 1, 0], "floor")
    things = [floor, sphere([0, 0, 0], 1.5, "glass"), sphere([0.3, 0.2, 0], 0.7, "air")]
    ways = (
        {"glass": glass(1.5, priority=0), "air": glass(1.0, priority=1, roughness=roughness)},
        {"glass": glass(1.5), "air": glass(1 / 1.5, roughness=roughness)},
    )
    sky = {"bottom": [0.1] * 3, "top": [1.0] * 3}
    first, second = (
        rendered(scene_of(things, {**way, "floor": MATTE}, camera, background=sky), context, 64)
        for way in ways
    )
    close = np.isclose(first.radiance, second.radiance, rtol=1e-3).all(axis=-1)
    assert close.mean() > 0.99  # the rest: rays that rounding sends another way


def test_a_surface_within_a_higher_glass_is_no_surface(context: Context) -> None:
    """A ball of low priority in one of a higher: as if it were not there, with as many bounces."""
    camera = {"position": [0, 0.5, 5], "look_at": [0, 0, 0], "fov": 40}
    things = [plane([0, -1.6, 0], [0, 1, 0], "floor"), sphere([0, 0, 0], 1.5, "glass")]
    inner = sphere([0.3, 0.2, 0], 0.7, "other")
    materials = {
        "glass": glass(1.5, priority=2),
        "other": tinted(2.4, 0.1, priority=1),
        "floor": MATTE,
    }
    sky = {"bottom": [0.1] * 3, "top": [1.0] * 3}
    first, second = (
        rendered(scene_of(some, materials, camera, background=sky), context, 64, bounces=3)
        for some in ([*things, inner], things)
    )
    close = np.isclose(first.radiance, second.radiance, rtol=1e-3).all(axis=-1)
    assert close.mean() > 0.99


def test_a_camera_under_water_looks_out_through_glass(context: Context) -> None:
    """n^2 of the water times what passes the layers below it."""
    things = [slab(20, "water", top=10), slab(1, "glass", top=-9.5)]
    materials = {"glass": glass(1.5, priority=2), "water": glass(1.33, priority=1)}
    image = rendered(through(things, materials), context, 4096, bounces=40)
    below, above = stack([1.33, 1.5, 1], [1]), stack([1.33, 1], [])
    back = (1 - above) * (1 - below)  # reflected above and below, again and again
    truth = 1.33**2 * below / (1 - back)
    assert_mean(whole(image), truth, within=0.03, floor=1e-5)


@pytest.mark.slow
def test_lamps_are_found_behind_surfaces_that_are_none(context: Context) -> None:
    """A lamp and a matte ball in glass, with a face of lower priority between them."""
    things = [
        sphere([0, 0, 0], 1.6, "glass"),
        sphere([-0.5, 0.2, 0], 0.4, "ball"),
        sphere([0.9, 0.3, 0.3], 0.4, "lamp"),
        box([0.2, -0.5, -0.6], [0.3, 0.9, 0.9], "low"),
    ]
    camera = {"position": [0, 0.3, 5], "look_at": [-0.45, 0.18, 0], "fov": 6}
    materials = {
        "glass": tinted(1.3, 2.0, priority=1),
        "low": tinted(2.0, 1.0, priority=0),
        "ball": MATTE,
        "lamp": lamp(6.0),
    }
    scene = scene_of(things, materials, camera)
    naive, nee, mis = (
        rendered(scene, context, 1024, method=method, bounces=4, seed=seed)
        for seed, method in enumerate(METHODS)
    )
    for other in (nee, mis):
        assert_agree(other, naive, within=0.08)
