"""Volumes that overlap by priority: closed forms, and scenes of disjoint volumes."""

from itertools import permutations
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.gpu.context import Context
from glrt.scene.scene import Scene
from tests.support.builders import box, glass, plane, quad, scene_of, sphere
from tests.support.media import DUSK, MATERIALS, MU, filled, medium
from tests.support.meshes import box as box_of_triangles
from tests.support.meshes import mesh
from tests.support.renders import assert_agree, rendered

THIN, DENSE = MU / 10, MU / 4
ABSORBING = {"thin": medium(absorption=THIN), "dense": medium(absorption=DENSE)}
BEHIND = quad([-20, -20, -20], [40, 0, 0], [0, 40, 0], "lamp")
EYE = {"fov": 0.01}


def ranked(thing: dict[str, Any], priority: int | None) -> dict[str, Any]:
    return {**thing, "priority": priority}


def slab(near: float, far: float, name: str | None, priority: int | None, size: float) -> Any:
    """A box across the line of sight, from `near` to `far` away."""
    body = box([-size, -size, -far], [size, size, -near], "")
    return ranked(filled(body, name), priority)


def seen(context: Context, *things: Any, **more: Any) -> Any:
    """Radiance of a lamp of 9 behind the slabs, over 9."""
    scene = scene_of([*things, BEHIND], MATERIALS, {**EYE, **more}, media=ABSORBING)
    return rendered(scene, context, 1, bounces=0).radiance[8, 8] / 9


# The thin slab lies from 4 to 10, the dense one from 8 to 14, and the hole from 9 to 12.
WHERE_THEY_OVERLAP = {
    "the thin one is there": ((1, 0, -1), (6, 4)),
    "the dense one is there": ((0, 1, -1), (4, 6)),
    "a hole in both": ((0, 1, 2), (4, 3)),
    "a hole in the thin one alone": ((0, 2, 1), (4, 6)),
    "a hole in the dense one alone": ((2, 0, 1), (6, 2)),
    "no priority is 0": ((None, -1, -2), (6, 4)),
}


@pytest.mark.parametrize("name", WHERE_THEY_OVERLAP)
def test_the_volume_of_the_highest_priority_holds_the_place(context: Context, name: str) -> None:
    (thin, dense, hole), lengths = WHERE_THEY_OVERLAP[name]
    slabs = [
        slab(4, 10, "thin", thin, 3),
        slab(8, 14, "dense", dense, 2.5),
        slab(9, 12, None, hole, 2),
    ]
    left = np.exp(-lengths[0] * THIN - lengths[1] * DENSE)
    for order in permutations(slabs):
        assert_allclose(seen(context, *order), left, rtol=1e-5)


def test_of_equal_priority_the_inner_one_wins(context: Context) -> None:
    """The dense slab lies wholly in the thin one, and both lie across a hole of less priority."""
    hole = slab(5, 16, None, 0, 2)
    slabs = [slab(4, 14, "thin", 1, 3), slab(8, 10, "dense", 1, 2.5), hole]
    for order in permutations(slabs):
        assert_allclose(seen(context, *order), np.exp(-8 * THIN - 2 * DENSE), rtol=1e-5)


@pytest.mark.parametrize(
    ("depth", "lengths"), [(3, (6, 4)), (6, (4, 4)), (9, (1, 4)), (11, (0, 3))]
)
def test_a_camera_begins_in_the_volumes_around_it(
    context: Context, depth: float, lengths: tuple[float, float]
) -> None:
    slabs = [slab(4, 10, "thin", 1, 3), slab(8, 14, "dense", 0, 2.5), slab(30, 31, None, 2, 2)]
    eye = {"position": [0, 0, -depth], "look_at": [0, 0, -40]}
    left = np.exp(-lengths[0] * THIN - lengths[1] * DENSE)
    assert_allclose(seen(context, *slabs, **eye), left, rtol=1e-5)


def test_light_of_lamps_crosses_volumes_that_overlap(context: Context) -> None:
    """A small lamp lights a wall, and the eye looks along its rays, past the lamp."""
    wall = quad([-20, -20, -20], [40, 0, 0], [0, 40, 0], "white")
    spot = quad([-0.01, 0.4, 0], [0.02, 0, 0], [0, 0.02, 0], "lamp")
    slabs = [slab(8, 14, "dense", 1, 5), slab(4, 10, "thin", 0, 6), slab(9, 12, None, 2, 4)]
    pictures = [
        rendered(
            scene_of([*things, wall, spot], MATERIALS, {"fov": 1}, media=ABSORBING),
            context,
            4,
            bounces=1,
        )
        for things in (slabs, [slab(30 + k, 30.5 + k, None, k, 2) for k in range(3)])
    ]
    dim, clear = (picture.radiance.mean(axis=(0, 1), dtype=np.float64) for picture in pictures)
    assert clear.min() > 1e-7
    assert_allclose(dim, clear * np.exp(-2 * (4 * THIN + 3 * DENSE)), rtol=2e-3)


FLOOR = plane([0, 0, 0], [0, 1, 0], "white")
ABOVE = quad([-0.5, 3, -0.5], [1, 0, 0], [0, 0, 1], "lamp")
ROOM: dict[str, Any] = {"position": [0, 1, 4], "look_at": [0, 1, 0], "fov": 45}
SCATTERING = {
    "fog": medium(scattering=[1, 2, 0.5], absorption=[0.1, 0.1, 0.3]),
    "smoke": medium(scattering=[0.5, 0.3, 2], absorption=[0.5, 0.2, 0.1], g=0.5),
}


def hazy(*bodies: Any, **more: Any) -> Scene:
    return scene_of(
        [FLOOR, ABOVE, *bodies],
        {**MATERIALS, "glass": glass(1.3), "other": glass(1.7)},
        ROOM,
        media=SCATTERING,
        background=DUSK,
        **more,
    )


@pytest.mark.slow
def test_two_fogs_that_overlap_are_as_two_apart(context: Context) -> None:
    """The fog of the left box reaches into the right one, whose smoke begins behind it."""
    fog = ranked(filled(box([-1.2, 0.01, -0.8], [0.2, 2, 0.8], "")), 1)
    smoke = filled(box([-0.5, 0.02, -0.6], [1.2, 1.8, 0.6], ""), "smoke")
    rest = filled(box([0.2001, 0.02, -0.6], [1.2, 1.8, 0.6], ""), "smoke")
    apart = {**fog, "priority": None}
    for near, far in (((fog, smoke), (apart, rest)), ((smoke, fog), (rest, apart))):
        pictures = [
            rendered(hazy(*things), context, 512, width=32, height=32, seed=seed)
            for seed, things in enumerate((near, far))
        ]
        assert_agree(pictures[0], pictures[1], 0.1)


@pytest.mark.slow
def test_a_volume_within_a_higher_one_changes_nothing(context: Context) -> None:
    """Glass with a lamp and fog: a block of other glass and a bound in it are not there."""
    block = ranked(filled(box([-1, 0.01, -1], [1, 2, 1], ""), "fog", "glass"), 2)
    bulb = sphere([0.5, 1, 0.2], 0.2, "lamp")
    hidden = filled(box([0, 0.5, -0.5], [0.9, 1.5, 0.5], ""), "smoke", "other")
    bound = filled(sphere([-0.5, 1, 0.2], 0.4, ""), "smoke")
    outside = [
        ranked(box([5, 5, -0.5], [6, 6, 0.5], "other"), 0),
        filled(sphere([-7, 1, 0], 0.5, ""), "smoke"),
    ]
    pictures = [
        rendered(hazy(block, bulb, *rest), context, 256, width=32, height=32, bounces=6, seed=seed)
        for seed, rest in enumerate(([hidden, bound], outside))
    ]
    assert_agree(pictures[0], pictures[1], 0.1)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["naive", "nee"])
def test_methods_agree_where_volumes_overlap(context: Context, method: str) -> None:
    """Light of the lamps crosses faces of glass that gives way to the glass around."""
    scene = hazy(
        ranked(filled(box([-1, 0.01, -1], [1, 2, 1], ""), "fog", "glass"), 1),
        sphere([0.5, 1, 0.2], 0.2, "lamp"),
        filled(box([0, 0.5, -0.5], [1.5, 1.5, 0.5], ""), "smoke", "other"),
        ranked(filled(sphere([-1, 1, 0.3], 0.5, ""), None), 3),
    )
    pictures = [
        rendered(scene, context, count, method=one, width=32, height=32, seed=seed, bounces=8)
        for seed, (one, count) in enumerate(((method, 2048), ("mis", 512)))
    ]
    assert_agree(pictures[0], pictures[1], 0.1)


@pytest.mark.slow
def test_milk_that_reaches_into_its_glass_is_milk_that_fits(context: Context) -> None:
    """The usual model, a hollow glass and a larger liquid, and a solid glass around the liquid."""
    materials = {
        **MATERIALS,
        "glass": glass(1.5),
        "milk": glass(1.33),
        "milk in glass": glass(1.33 / 1.5),
    }
    low, high = [-0.6, 0.3, -0.6], [0.6, 1.6, 0.6]
    outer, inner = (
        box_of_triangles([-0.8, 0.01, -0.8], [0.8, 1.8, 0.8]),
        box_of_triangles(low, high),
    )
    shell = (
        np.concatenate([outer[0], inner[0]]),
        np.concatenate([outer[1], inner[1][:, ::-1] + len(outer[0])]),
    )
    wide = [np.array(low) - 0.1, np.array(high) + 0.1]
    modelled = [
        ranked(mesh(shell, "glass", smooth=False), 1),
        filled(box(wide[0].tolist(), wide[1].tolist(), ""), "smoke", "milk"),
    ]
    solid = box([-0.8, 0.01, -0.8], [0.8, 1.8, 0.8], "glass")
    exact = [solid, filled(box(low, high, ""), "smoke", "milk in glass")]
    pictures = [
        rendered(
            scene_of([FLOOR, ABOVE, *things], materials, ROOM, media=SCATTERING, background=DUSK),
            context,
            1024,
            width=32,
            height=32,
            bounces=30,
            seed=seed,
        )
        for seed, things in enumerate((modelled, exact))
    ]
    assert_agree(pictures[0], pictures[1], 0.1)
