"""The light of lamps towards a direction, and the places that see them."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.packing.emission_cones import Aims, around_all, cone_fields, everywhere
from glrt.scene.lights.cone import Cone
from glrt.scene.scene import Scene
from tests.conftest import CallGlsl
from tests.support.builders import lamp, quad, scene_of, sphere
from tests.support.numerics import Array, directions, float32

CONES = {
    "wide": Cone(axis=(0, -1, 0), inner=20, outer=70),
    "narrow": Cone(axis=(1, -1, 0.5), inner=0.05, outer=0.1),
    "hard": Cone(axis=(0.3, 1, 0), inner=30, outer=30),
    "nearly all": Cone(axis=(0, 0, 1), inner=120, outer=180),
}


def lit(cone: Cone, **more: Any) -> Scene:
    material = lamp(2.0, cone=cone.model_dump())
    return scene_of([sphere([0, 0, -3], 0.5, "lamp") | more], {"lamp": material})


def near(cone: Cone, count: int = 20_000) -> Array:
    """Unit vectors, most of them about the edge of a cone."""
    random = np.random.default_rng(5)
    angle = np.radians(cone.outer) * random.uniform(0, 1.2, count)
    turn = random.uniform(0, 2 * np.pi, count)
    axis = cone.unit_axis
    aside = np.cross(axis, [0.36, 0.48, 0.8])
    aside /= np.linalg.norm(aside)
    round_ = np.cos(turn)[:, None] * aside + np.sin(turn)[:, None] * np.cross(axis, aside)
    found = np.cos(angle)[:, None] * axis + np.sin(angle)[:, None] * round_
    return np.concatenate([found, directions(1000)]).astype(np.float32)


@pytest.mark.parametrize("name", CONES)
def test_emission_has_the_share_of_the_cone(call_glsl: CallGlsl, name: str) -> None:
    """The share is exact to a few roundings of the direction: 1e-7 of an angle."""
    cone = CONES[name]
    towards = near(cone)
    found = call_glsl(
        "emitted(material_at(0), direction, true).x", scene=lit(cone), direction=towards
    )
    exact = 2 * cone.shares(towards.astype(np.float64))
    width = cone.versines[1] - cone.versines[0]
    if width:
        rounded = 6e-7 * math.sin(math.radians(cone.outer)) / width
        assert_allclose(found, exact, atol=rounded + 4e-6)
        assert ((exact > 0) & (exact < 2)).sum() > 100
    assert (found[exact == 2] > 1.99).mean() > 0.999
    assert (found[exact == 0] < 0.01).mean() > 0.999


def test_a_side_that_is_dark_emits_nothing(call_glsl: CallGlsl) -> None:
    square = quad([0, 0, -3], [1, 0, 0], [0, 1, 0], "lamp") | {"emission_side": "front"}
    scene = scene_of([square], {"lamp": lamp(2.0)})
    ray = "vec3(0.0, 0.0, 1.0)"
    for facing, radiance in (("true", 2.0), ("false", 0.0)):
        found = call_glsl(f"emitted(material_at(0), {ray}, {facing}).x", scene=scene)
        assert found.tolist() == [radiance]


@pytest.mark.parametrize("reach", [0.0, 1e-3, 0.3, 2.0])
@pytest.mark.parametrize("name", CONES)
def test_what_a_lamp_lights_is_within_its_aim(call_glsl: CallGlsl, name: str, reach: float) -> None:
    """Lamps in a ball, each seen from a place: the share is not above that of them all."""
    cone = CONES[name]
    outer, slope = cone_fields(cone)
    aims = Aims(cone.unit_axis[None], np.array([outer]), np.array([slope]))
    random = np.random.default_rng(7)
    towards = near(cone).astype(np.float64)
    inside = directions(len(towards), 3)[: len(towards)] * reach
    place = float32(inside + towards * random.uniform(0.1, 3, (len(towards), 1)))
    exact = cone.shares((place - inside) / np.linalg.norm(place - inside, axis=1)[:, None])
    found = call_glsl(
        "share_towards(Aim(axis, outer, slope, reach), place)",
        scene=lit(cone),
        place=place,
        axis=np.repeat(aims.axis, len(place), axis=0),
        outer=aims.outer,
        slope=aims.slope,
        reach=np.array([reach]),
    )
    assert (found[exact > 0] > 0).all()
    assert (found >= exact - 1e-3).all()
    if reach == 0 and cone.outer > 1:
        assert_allclose(found, exact, atol=1e-3 if slope < 1e20 else 1)
    if reach < 0.1 and cone.outer < 90:
        assert (found == 0).any(), "it is never chosen where it cannot be seen"


def test_an_aim_around_several_holds_each() -> None:
    random = np.random.default_rng(2)
    for _ in range(200):
        axis = random.normal(size=3) + random.normal(size=(5, 3)) * random.uniform(0, 0.5)
        cones = [Cone(axis=tuple(a), outer=random.uniform(1, 80)) for a in axis]
        fields = np.array([cone_fields(cone) for cone in cones])
        units = np.array([cone.unit_axis for cone in cones])
        aim = around_all(Aims(units, fields[:, 0], fields[:, 1]))
        towards = directions(500, 4).astype(np.float64)
        lit_by_some = np.max([cone.shares(towards) for cone in cones], axis=0) > 0
        versine = np.square(towards - aim.axis[0]).sum(axis=1) / 2
        assert (versine[lit_by_some] < aim.outer[0]).all()


def test_of_equal_aims_one_is_kept_and_one_without_end_is_all() -> None:
    cone = CONES["wide"]
    outer, slope = cone_fields(cone)
    several = Aims(np.tile(cone.unit_axis, (3, 1)), np.full(3, outer), np.full(3, slope))
    kept = around_all(several)
    assert (kept.outer[0], kept.slope[0]) == (outer, slope)
    mixed = Aims(*(np.concatenate(pair) for pair in zip(several, everywhere(1), strict=True)))
    assert around_all(mixed).outer[0] > 2
    opposite = Aims(np.array([[0, 1.0, 0], [0, -1.0, 0]]), np.full(2, outer), np.full(2, slope))
    assert around_all(opposite).outer[0] > 2
