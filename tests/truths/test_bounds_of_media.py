"""Bounds of media: by scenes that mean the same, and against closed forms."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from tests.support.builders import box, glass, plane, quad, scene_of, sphere
from tests.support.media import DUSK, EVEN, FAR, HAZE, MU, ball, filled, medium, with_fog
from tests.support.meshes import box as box_of_triangles
from tests.support.meshes import mesh
from tests.support.renders import assert_agree, assert_mean, rendered, whole

FLOOR = plane([0, 0, 0], [0, 1, 0], "white")
ABOVE = quad([-0.5, 3, -0.5], [1, 0, 0], [0, 0, 1], "lamp")
THIN = medium(scattering=[0.1, 0.2, 0.05], absorption=[0.01, 0.01, 0.03])
ROOM: dict[str, Any] = {"position": [0, 1, 4], "look_at": [0, 1, 0], "fov": 45}


def hazy(*bodies: Any, fog: Any = HAZE, **more: Any) -> Scene:
    return with_fog([FLOOR, ABOVE, *bodies], fog, ROOM, background=DUSK, **more)


def block(low: float = 1e-3, material: str = "none", name: str | None = "fog") -> Any:
    return filled(box([-1, low, -1], [1, 2, 1], ""), name, material)


ONE_MEANING: dict[str, tuple[Scene, Scene]] = {
    "a bound within the same medium": (
        hazy(block()),
        hazy(block(), filled(sphere([0, 1, 0], 0.5, ""))),
    ),
    "a bound that reaches through the floor": (hazy(block()), hazy(block(-0.5))),
    "a bound in the plane of the floor": (hazy(block()), hazy(block(0.0))),
    "the floor after the bound": (
        hazy(block()),
        with_fog([block(0.0), FLOOR, ABOVE], HAZE, ROOM, background=DUSK),
    ),
    "everywhere": (
        with_fog([FLOOR, ABOVE], THIN, ROOM, medium="fog"),
        with_fog([FLOOR, ABOVE, filled(box([-60, -1, -60], [60, 60, 60], ""))], THIN, ROOM),
    ),
    "triangles": (
        hazy(block()),
        hazy(filled(mesh(box_of_triangles([-1, 1e-3, -1], [1, 2, 1]), ""))),
    ),
}


@pytest.mark.slow_cases(
    "a bound within*", "a bound in the*", "the floor after*", "everywhere", "triangles"
)
@pytest.mark.parametrize("name", ONE_MEANING)
def test_two_ways_to_say_the_same_give_the_same_picture(context: Context, name: str) -> None:
    pictures = [
        rendered(scene, context, 128, seed=seed, width=32, height=32)
        for seed, scene in enumerate(ONE_MEANING[name])
    ]
    assert_agree(pictures[0], pictures[1], 0.1)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["naive", "nee"])
def test_methods_agree_in_fog(context: Context, method: str) -> None:
    scene = hazy(
        block(),
        filled(sphere([1.8, 0.6, 0], 0.5, ""), material="glass"),
        materials={"glass": glass(1.3)},
    )
    pictures = [
        rendered(scene, context, count, method=one, width=32, height=32, seed=seed)
        for seed, (one, count) in enumerate(((method, 1024), ("mis", 256)))
    ]
    assert_agree(pictures[0], pictures[1], 0.1)


@pytest.mark.slow
def test_glass_of_the_index_of_air_is_no_more_than_a_bound(context: Context) -> None:
    """Each of its faces is a bounce, so that the limit is high."""
    bounds = hazy(block())
    window = hazy(block(material="glass"), materials={"glass": glass(1.0)})
    pictures = [
        rendered(scene, context, 512, method="naive", bounces=100, seed=seed, width=32, height=32)
        for seed, scene in enumerate((bounds, window))
    ]
    assert_agree(pictures[0], pictures[1], 0.1)


@pytest.mark.parametrize("x", [0.0, 2.0])
def test_an_object_without_a_medium_holds_vacuum_in_fog(context: Context, x: float) -> None:
    """Fog is all around but in a bubble before the camera, or around it; a lamp is 5 away."""
    behind = quad([-9, -9, -5], [18, 0, 0], [0, 18, 0], "lamp")
    bubble = filled(sphere([0, 0, -x], 0.5, ""), None)
    scene = with_fog([behind, bubble], medium(absorption=MU), {"fov": 0.01}, medium="fog")
    image = rendered(scene, context, 1)
    length = 5 - (0.5 if x == 0 else 1)
    assert_allclose(image.radiance[8, 8], 9 * np.exp(-length * MU), rtol=1e-5)


def test_a_bound_is_no_bounce(context: Context) -> None:
    """The eye in a ball of gas sees direct light on a wall outside, within one bounce."""
    wall = quad([-9, -9, -3], [18, 0, 0], [0, 18, 0], "white")
    bulb = sphere([0, 3, -1], 0.2, "lamp")
    gas = filled(sphere([0, 0, 0], 1, ""))
    pictures = [
        rendered(with_fog(things, medium(absorption=MU), {"fov": 1}), context, 16, bounces=1)
        for things in ([wall, bulb, gas], [wall, bulb])
    ]
    dim, clear = (picture.radiance.mean(axis=(0, 1), dtype=np.float64) for picture in pictures)
    assert clear.min() > 0.01
    assert_allclose(dim, clear * np.exp(-MU), rtol=0.02)


@pytest.mark.slow
def test_many_bounds_are_passed(context: Context) -> None:
    """Sixteen of them stand between the eye and a lamp."""
    lamp_behind = quad([-9, -9, -40], [18, 0, 0], [0, 18, 0], "lamp")
    slabs = [filled(box([-9, -9, -z - 0.5], [9, 9, -z], "")) for z in range(1, 9)]
    scene = with_fog([*slabs, lamp_behind], medium(absorption=MU / 10), {"fov": 1})
    image = rendered(scene, context, 1, bounces=0)
    assert_allclose(image.radiance[8, 8], 9 * np.exp(-0.4 * MU), rtol=1e-3)


def test_a_medium_in_glass_within_fog_is_left_and_entered(context: Context) -> None:
    """All white: an even sky stays even through glass, milk and fog."""
    milk = filled(sphere([0, 0, 0], 0.5, ""), "milk", "glass")
    fog = medium(scattering=[1, 2, 0.5])
    scene = scene_of(
        [ball(), milk],
        {"glass": glass(1.3)},
        {**FAR, "fov": 20},
        media={"fog": fog, "milk": medium(scattering=[4, 3, 2], g=0.7)},
        background=EVEN,
    )
    image = rendered(scene, context, 256, bounces=1000, roulette=False)
    assert_mean(whole(image), [1.0] * 3, 0.02)


def test_a_medium_in_glass_shines_through_fog(context: Context) -> None:
    """Along the axis: the face of the glass lets through its share, fog what Beer leaves."""
    glow, dim = np.array([1.0, 2.0, 3.0]), np.array([0.2, 0.5, 1.0])
    block = filled(box([-90, -90, -6], [90, 90, -4], ""), "glow", "glass")
    scene = scene_of(
        [block],
        {"glass": glass(1.5)},
        {"fov": 0.01},
        media={
            "fog": medium(scattering=0.3 * MU, absorption=0.1),
            "glow": medium(absorption=dim, emission=glow.tolist()),
        },
        medium="fog",
    )
    image = rendered(scene, context, 8192, method="naive", bounces=1, sampler="sobol")
    inside = glow * -np.expm1(-2 * dim) / dim  # one way through it: a bounce ends at its back
    truth = np.exp(-4 * (0.3 * MU + 0.1)) * 0.96 / 1.5**2 * inside
    assert_mean(whole(image), truth, 0.05)


def test_gas_shines_through_fog(context: Context) -> None:
    """Bounds alone lie between: the flight through fog goes on in the gas."""
    dim, glow = np.array([0.2, 0.5, 1.0]), [1.0, 2.0, 3.0]
    things = [filled(sphere([0, 0, -4], 1, ""), "glow")]
    scene = scene_of(
        things,
        {},
        {"fov": 0.01},
        media={
            "fog": medium(scattering=0.3 * MU, absorption=0.1),
            "glow": medium(absorption=dim, emission=glow),
        },
        medium="fog",
    )
    image = rendered(scene, context, 4096, bounces=0)
    truth = np.exp(-3 * (0.3 * MU + 0.1)) * glow * -np.expm1(-2 * dim) / dim
    assert_mean(whole(image), truth, 0.05)


def test_a_sheet_in_the_plane_of_a_half_space_is_seen(context: Context) -> None:
    """A plane comes before a quad where two surfaces share a place, but this one is none."""
    half = filled(plane([0, 0, -2], [0, 0, 1], ""))
    sheet = quad([-1, -1, -2], [2, 0, 0], [0, 2, 0], "lamp")
    white = quad([-9, -9, -2], [8, 0, 0], [0, 18, 0], "white")
    scene = with_fog([half, sheet, white], medium(absorption=50), {"fov": 20}, background=EVEN)
    assert (rendered(scene, context, 4).radiance == 9).all()
    aside = {"position": [-4, 0, 0], "look_at": [-4, 0, -1], "fov": 20}
    lit = with_fog([half, sheet, white], medium(absorption=50), aside, background=EVEN)
    assert rendered(lit, context, 64).radiance.min() > 0.2
