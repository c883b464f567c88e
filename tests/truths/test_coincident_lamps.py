"""Lamps that share a place with other surfaces: a place has one surface, in every method.

An emitter that faces the ray comes first, then the surface of the lower number. The light of
rectangles on a point below is known in closed form.
"""

from typing import Any

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.scene.coincidence import coincidence_of
from glrt.scene.scene import Scene
from tests.support.builders import (
    MATTE,
    box,
    box_of_quads,
    disk,
    glass,
    lamp,
    plane,
    quad,
    scene_of,
    sphere,
)
from tests.support.meshes import mesh, quads
from tests.support.renders import (
    METHODS,
    Estimate,
    assert_agree,
    assert_mean,
    rendered,
    same,
    whole,
)
from tests.truths.test_direct_light import rectangle_form_factor

FLOOR = plane([0, 0, 0], [0, 1, 0], "floor")
MATERIALS = {"floor": MATTE, "lamp": lamp(2.0), "bright": lamp(6.0)}
ASIDE = {"position": [-4, 0.5, 0], "look_at": [0, 0, 0], "fov": 0.01}
UP = {"position": [0.5, 0, 0], "look_at": [0.5, 1, 0], "up": [0, 0, 1], "fov": 90}
DEPTH = 1.0  # of all lamps along z, from -DEPTH / 2 on


def over(start: float, end: float, material: str, height: float = 1.0) -> dict[str, Any]:
    """A lamp above the floor, from `start` to `end` along x; its normal points up."""
    return quad([start, height, -DEPTH / 2], [0, 0, DEPTH], [end - start, 0, 0], material)


def front(thing: dict[str, Any], down: bool = False) -> dict[str, Any]:
    """A lamp that emits from the side of its normal, which may be turned down."""
    edges = {"edge_u": thing["edge_v"], "edge_v": thing["edge_u"]} if down else {}
    return {**thing, **edges, "emission_side": "front"}


def light_of(start: float, end: float, radiance: float) -> float:
    """Radiance of a floor of albedo 1/2 below a lamp from `start` to `end`."""

    def to(x: float) -> float:
        return 2 * float(np.sign(x)) * rectangle_form_factor(abs(x), DEPTH / 2)

    return radiance / 2 * (to(end) - to(start))


def triangles(start: float, end: float, height: float = 1.0) -> dict[str, Any]:
    """Two triangles of a mesh in place of a quad."""
    edges = [[start, height, -DEPTH / 2], [0, 0, DEPTH], [end - start, 0, 0]]
    return mesh(quads(edges), "lamp", smooth=False)


# Objects above the floor, and the light below.
CASES: dict[str, tuple[list[dict[str, Any]], float]] = {
    "two that overlap, the dim one first": (
        [over(-1, 1, "lamp"), over(0, 2, "bright")],
        light_of(-1, 1, 2) + light_of(1, 2, 6),
    ),
    "two that overlap, the bright one first": (
        [over(0, 2, "bright"), over(-1, 1, "lamp")],
        light_of(-1, 0, 2) + light_of(0, 2, 6),
    ),
    "one in the plane of a ceiling": (
        [over(-3, 3, "floor"), over(-1, 1, "lamp")],
        light_of(-1, 1, 2),
    ),
    "one in an endless ceiling": (
        [plane([5, 1, 3], [0, -1, 0], "floor"), over(-1, 1, "lamp")],
        light_of(-1, 1, 2),
    ),
    "one on the face of a box": (
        [over(-1, 1, "lamp"), box([-0.5, 1, -1], [2, 2, 1], "floor")],
        light_of(-1, 1, 2),
    ),
    "two back to back, of one side each": (
        [front(over(-1, 1, "bright")), front(over(-1, 1, "lamp"), down=True)],
        light_of(-1, 1, 2),
    ),
    "one of one side under a ceiling that comes first": (
        [over(-3, 3, "floor"), front(over(-1, 1, "lamp"), down=True)],
        light_of(-1, 1, 2),
    ),
    "one that shines up, in the place of a ceiling": (
        [over(-3, 3, "floor"), front(over(-1, 1, "lamp"))],
        0.0,
    ),
    "a mesh next to its copy": (
        [triangles(-1, 1), triangles(-1, 1, 1 + 1e-7)],
        light_of(-1, 1, 2),
    ),
    "a mesh that covers half of a quad": (
        [over(-1, 1, "lamp"), triangles(0, 2)],
        light_of(-1, 2, 2),
    ),
    "a disk within a quad": (
        [over(-1, 1, "lamp"), disk([0, 1, 0], [0, 1, 0], 0.4, "bright")],
        light_of(-1, 1, 2),
    ),
    "among many shapes, in a tree": (
        [
            *(sphere([n, 9, 9], 0.1, "floor") for n in range(40)),
            *(quad([n, 9, 8], [0.1, 0, 0], [0, 0.1, 0], "floor") for n in range(40)),
            *(over(-3, 3, "floor"), over(-1, 1, "lamp"), over(0, 2, "bright")),
        ],
        light_of(-1, 1, 2) + light_of(1, 2, 6),
    ),
}


def scene(things: list[dict[str, Any]], camera: dict[str, Any] = ASIDE) -> Scene:
    made = scene_of([FLOOR, *things], MATERIALS, camera)
    assert coincidence_of(made).pairs
    return made


@pytest.mark.slow_cases(
    "two that overlap, the dim one first-nee",
    "one in the plane of a ceiling-nee",
    "one of one side under a ceiling that comes first-nee",
)
@pytest.mark.slow_cases(
    "one on the face of a box-naive",
    "one on the face of a box-nee",
    "one on the face of a box-mis",
    "two back to back, of one side each-nee",
    "two back to back, of one side each-mis",
    "a mesh next to its copy-naive",
    "a mesh next to its copy-nee",
    "a mesh next to its copy-mis",
    "a mesh that covers half of a quad-naive",
    "a mesh that covers half of a quad-nee",
    "a mesh that covers half of a quad-mis",
    "a disk within a quad-naive",
    "a disk within a quad-nee",
    "a disk within a quad-mis",
    "among many shapes, in a tree-naive",
    "among many shapes, in a tree-nee",
    "among many shapes, in a tree-mis",
)
@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("case", CASES)
def test_the_light_below_is_that_of_what_is_seen(context: Context, case: str, method: str) -> None:
    things, truth = CASES[case]
    samples = 1024 if method == "naive" else 128
    settings: dict[str, Any] = {"method": method, "bounces": 1, "tier": "generic"}
    image = rendered(scene(things), context, samples, **settings)
    if truth == 0:
        assert not image.radiance.any()
    else:
        assert_mean(whole(image), truth, within=0.07, floor=1e-5 * truth)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["gather", "resampled"])
def test_so_it_is_where_probes_are_asked(context: Context, method: str) -> None:
    things, truth = CASES["two that overlap, the dim one first"]
    settings: dict[str, Any] = {"method": method, "probes": 2, "sampler": "sobol"}
    made = scene(things)
    pixels = rendered(made, context, 128, bounces=1, tier="generic", **settings).radiance
    spread = pixels.std(axis=(0, 1), dtype=np.float64) / 16  # of 256 pixels that see one point
    assert_mean(Estimate(pixels.mean(axis=(0, 1)), spread), truth, within=0.07, floor=1e-5)


@pytest.mark.slow
def test_particles_leave_the_lamp_that_is_seen(context: Context) -> None:
    """Below a glass ball most light comes by particles; apart, the lamps share no place."""
    ball = sphere([0.5, 0.5, 0], 0.3, "glass")
    camera = {"position": [0.5, 0.45, -1.5], "look_at": [0.5, 0, 0], "fov": 25}
    materials = MATERIALS | {"glass": glass()}
    together = [over(-1, 1, "lamp"), over(0, 2, "bright")]
    apart = [over(-1, 1, "lamp"), over(1, 2, "bright")]
    settings: dict[str, Any] = {"caustics": "on", "linked": 0.0, "bounces": 3, "tier": "generic"}
    scenes = [scene_of([FLOOR, ball, *lamps], materials, camera) for lamps in (together, apart)]
    one, two = (rendered(it, context, 512, seed=k, **settings) for k, it in enumerate(scenes))
    assert_agree(one, two, within=0.05)


@pytest.mark.parametrize("turned", [False, True])
def test_overlapping_lamps_are_seen_without_a_speck(context: Context, turned: bool) -> None:
    """The camera sees x from -1/2 to 3/2; one lamp ends at 1, the other begins at 0."""
    things = [over(-1, 1, "lamp"), over(0, 2, "bright")]
    camera = {**UP, "up": [1, 0, 0]}
    made = scene(things[::-1] if turned else things, camera)
    image = rendered(made, context, 4, bounces=0, tier="generic")
    rows = np.unique(
        image.radiance[:, 4:12, 0], axis=1
    )  # the lamps are as wide as half the picture
    assert rows.shape == (16, 1)
    expected = [2.0] * (4 if turned else 12) + [6.0] * (12 if turned else 4)
    assert sorted(rows[:, 0]) == expected
    assert list(rows[:, 0]) in (expected, expected[::-1])


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_a_furnace_of_doubled_walls_is_even(context: Context, method: str) -> None:
    """Walls of radiance 1 and albedo 1/2, partly doubled: 2 (1 - 2^-7)."""
    wall = {"type": "light", "emission": [1.0] * 3, "color": [0.5] * 3}
    shapes = [
        *box_of_quads("wall"),
        quad([-1, -1, -1], [2, 0, 0], [0, 0, 1.5], "wall"),
        quad([-0.5, 1, -1], [1, 0, 0], [0, 0, 2], "wall"),
        disk([1, 0, 0], [1, 0, 0], 1.0, "wall"),
        mesh(quads([[-1, -1, -1], [2, 0.5, 0], [0, 1, 0]]), "wall", smooth=False),
    ]
    made = scene_of(shapes, {"wall": wall}, {"position": [0.1, 0.2, 0.3], "fov": 100})
    assert len(coincidence_of(made).pairs) == 4
    settings: dict[str, Any] = {"method": method, "bounces": 6, "roulette": False}
    image = rendered(made, context, 64, **settings)
    truth = 2 * (1 - 2.0**-7)
    if method == "naive":
        np.testing.assert_allclose(image.radiance, truth, rtol=2e-5)
    else:
        assert_mean(whole(image), truth, within=0.03, floor=1e-5)


def test_a_place_scales_by_powers_of_two(context: Context) -> None:
    def scaled(by: float) -> Scene:
        things = [over(-3, 3, "floor"), over(-1, 1, "lamp"), over(0, 2, "bright")]
        for thing in things:
            thing |= {key: [by * x for x in thing[key]] for key in ("corner", "edge_u", "edge_v")}
        camera = {"position": [0, 0.5 * by, -1 * by], "look_at": [0, by, 0], "fov": 90}
        return scene(things, camera)

    settings: dict[str, Any] = {"tier": "generic", "bounces": 3}
    one, large = (rendered(scaled(by), context, 8, **settings) for by in (1.0, 2.0**10))
    assert same(one, large)
    assert one.radiance.mean() > 0.5
