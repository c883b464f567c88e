"""The choice of a lamp: the alias table is exact, and lamps are weighed by their flux."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt import needs
from glrt.context import Context
from glrt.needs import MOST_NEAR, needs_of
from glrt.pack import alias_table, light_probabilities, pack_scene
from glrt.scene import Scene
from glrt.settings import Cost, settings_for
from tests.builders import plane, scene_of, sphere
from tests.conftest import CallGlsl
from tests.numerics import BELOW_ONE, Array
from tests.renders import assert_agree, rendered, rendering
from tests.test_light import LAMPS, MANY


def chosen(keep: Array, alias: Array) -> Array:
    """The probability of each index that an alias table stands for."""
    share = keep.astype(np.float64) + np.bincount(alias, 1 - keep.astype(np.float64), len(keep))
    table: Array = share / len(keep)
    return table


POWERS = {
    "one": [3.0],
    "equal": [1.0] * 7,
    "one bright": [1e9] + [1.0] * 9,
    "some dark": [0.0, 2.0, 0.0, 5.0],
    "all dark": [0.0, 0.0, 0.0],
    "a thousand": list(10.0 ** np.random.default_rng(2).uniform(-6, 6, 1000)),
}


@pytest.mark.parametrize("powers", POWERS.values(), ids=POWERS)
def test_the_alias_table_stands_for_the_probabilities_exactly(powers: list[float]) -> None:
    probability = light_probabilities(powers)
    keep, alias = alias_table(probability)
    assert_allclose(chosen(keep, alias), probability, rtol=0, atol=1e-15)
    assert np.all((keep >= 0) & (keep <= 1 + 1e-12))
    assert np.all((alias >= 0) & (alias < len(powers)))


@pytest.mark.parametrize("powers", POWERS.values(), ids=POWERS)
def test_every_lamp_has_a_chance_and_a_brighter_one_has_more(powers: list[float]) -> None:
    probability = light_probabilities(powers)
    assert probability.sum() == pytest.approx(1, abs=1e-12)
    assert probability.min() >= 0.5 / len(powers) * (1 - 1e-12)
    assert np.all(np.diff(probability[np.argsort(powers)]) >= 0)


def test_a_table_for_any_probabilities_stands_for_them() -> None:
    random = np.random.default_rng(3)
    for count in range(1, 200):
        probability = random.dirichlet(np.full(count, 0.2))
        assert_allclose(chosen(*alias_table(probability)), probability, rtol=0, atol=1e-14)


def test_lamps_are_weighed_by_flux() -> None:
    lights = pack_scene(MANY)["Lights"]
    flux = np.array([4 * np.pi * 30, np.pi * 2, np.pi / 4 * 2, 2 * 4 * 2, 0])  # area x radiance
    assert_allclose(lights["probability"], 0.1 + 0.5 * flux / flux.sum(), rtol=1e-6)


def test_a_lamp_is_chosen_as_often_as_its_density_says(call_glsl: CallGlsl) -> None:
    lights = pack_scene(MANY)["Lights"]
    u = (np.arange(2**18) + 0.5) / 2**18
    index = call_glsl("choose_by_table(u)", "int", scene=MANY, u=u)
    frequency = np.bincount(index, minlength=len(lights)) / len(u)
    assert_allclose(frequency, lights["probability"], atol=1e-5)


def test_the_choice_stays_within_the_lamps_at_the_ends(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(4)
    balls = [sphere(place, 0.01, "lamp") for place in random.uniform(-9, 9, (999, 3))]
    scene = scene_of(balls, LAMPS, render={"bounces": 1})
    u = np.concatenate([np.arange(999) / 999, [BELOW_ONE, 2.0**-24], random.uniform(size=10_000)])
    index = call_glsl("choose_by_table(u)", "int", scene=scene, u=np.minimum(u, BELOW_ONE))
    assert index.min() >= 0
    assert index.max() == 998


# --- few lamps -----------------------------------------------------------------------------


FROM = "Ray from = Ray(origin, vec3(0.0, 1.0, 0.0), NO_SHAPE, false);"


def weights(scene: Scene, origin: Array) -> Array:
    """Of each lamp at each point, (n, lamps) float64: flux over squared distance."""
    lights = pack_scene(scene)["Lights"]
    away = lights["center"].astype(np.float64) - origin[:, None]
    nearness: Array = 1 / np.maximum((away**2).sum(axis=-1), lights["reach2"])
    return lights["probability"] * nearness


def balls(count: int) -> Scene:
    random = np.random.default_rng(count)
    return scene_of(
        [sphere(place, 0.1, "lamp") for place in random.uniform(-2, 2, (count, 3))], LAMPS
    )


@pytest.mark.parametrize("count", [2, 3, 31, MOST_NEAR])
def test_few_lamps_are_chosen_by_flux_over_squared_distance(
    call_glsl: CallGlsl, count: int
) -> None:
    """Shares of the unit interval are as wide as the density says: they end where it says."""
    scene, points = balls(count), np.random.default_rng(1).uniform(-2, 2, (8, 3))
    share = weights(scene, points)
    share /= share.sum(axis=1, keepdims=True)
    u = (np.arange(2**12) + 0.5) / 2**12
    origin, u = np.repeat(points, len(u), axis=0), np.tile(u, len(points))
    found = call_glsl(
        "vec2(index, choice_pdf(light_at(index), from, total))",
        "vec2",
        setup=f"{FROM} float total = total_weight(from); int index = choose_light(from, total, u);",
        scene=scene,
        origin=origin,
        u=u,
    ).reshape(len(points), -1, 2)
    for exact, (index, pdf) in zip(share, np.moveaxis(found, 2, 1), strict=True):
        chosen = index.astype(int)
        assert_allclose(pdf, exact[chosen], rtol=1e-5)
        assert_allclose(np.bincount(chosen, minlength=count) / 2**12, exact, atol=2.0**-11)


def test_a_lamp_has_its_chance_at_the_very_ends(call_glsl: CallGlsl) -> None:
    u = np.array([0.0, BELOW_ONE])
    for count in (2, 5, MOST_NEAR):
        setup = f"{FROM} int index = choose_light(from, total_weight(from), u);"
        origin = np.tile([0.3, 0.1, 0.2], (2, 1))
        args = {"setup": setup, "scene": balls(count), "origin": origin, "u": u}
        assert call_glsl("index", "int", **args).tolist() == [0, count - 1]


def test_more_lamps_than_that_are_chosen_by_the_table() -> None:
    """And one lamp is not chosen at all; naive chooses none."""
    for count, few in ((1, 1), (2, 2), (MOST_NEAR, MOST_NEAR), (MOST_NEAR + 1, 0)):
        scene = balls(count)
        assert needs_of(scene, settings_for(scene.render)).few_lights == few
        assert needs_of(scene, settings_for(scene.render, method="naive")).few_lights == 0


def test_another_lamp_compiles_where_lamps_are_weighed(context: Context) -> None:
    """Their number is a constant of the kernel; of many, and of what gives no light, it is not."""
    for count, cost in ((2, Cost.RECOMPILE), (MOST_NEAR + 1, Cost.RESTART)):
        with rendering(balls(count), context) as renderer:
            assert renderer.update(balls(count + 1)) is cost


def test_the_lamp_just_left_is_not_chosen(call_glsl: CallGlsl) -> None:
    scene, u = balls(3), (np.arange(64) + 0.5) / 64
    for left in range(3):
        setup = (
            f"{FROM} from.leaves = {left}; int index = choose_light(from, total_weight(from), u);"
        )
        args = {"setup": setup, "origin": np.zeros((64, 3)), "u": u}
        chosen = call_glsl("index", "int", scene=scene, **args)
        assert set(chosen.tolist()) == {0, 1, 2} - {left}


def test_a_dark_lamp_keeps_its_chance(call_glsl: CallGlsl) -> None:
    """Its group may be lit again without a restart."""
    objects = [sphere([-1, 0, 0], 0.1, "lamp"), sphere([1, 0, 0], 0.1, "dark")]
    u = np.array([0.1, 0.9])
    setup = f"{FROM} int index = choose_light(from, total_weight(from), u);"
    args = {"setup": setup, "origin": np.zeros((2, 3)), "u": u}
    chosen = call_glsl("index", "int", scene=scene_of(objects, LAMPS), **args)
    assert chosen.tolist() == [0, 1]


@pytest.mark.parametrize("count", [MOST_NEAR, 2 * MOST_NEAR, 300])
def test_many_lamps_bring_the_light_that_scattering_finds(context: Context, count: int) -> None:
    """Small balls under a ceiling; measured: errors of 0.03 with 32 of them, 0.06, and 0.07."""
    random = np.random.default_rng(count)
    places = random.uniform([-2, 0.6, -4], [2, 0.9, -2], (count, 3))
    lamps = [sphere(place, 2 / count**0.5 / 10, "lamp") for place in places]
    walls = [plane([0, y, 0], [0, -y, 0], "matte") for y in (-1, 1)]
    scene = scene_of([*walls, plane([0, 0, -4.5], [0, 0, 1], "matte"), *lamps], LAMPS)
    size = {"width": 32, "height": 32, "bounces": 3}
    by_choice = rendered(scene, context, 1024, seed=1, **size)
    by_scattering = rendered(scene, context, 1024, seed=2, method="naive", **size)
    assert_agree(by_choice, by_scattering, within=0.05)
    assert by_choice.error is not None
    assert by_choice.error < 0.1


def test_a_corridor_needs_a_third_of_the_samples(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Against a choice by flux alone: measured 0.55 of the error."""
    walls = [plane([0, y, 0], [0, -y, 0], "matte") for y in (-1, 1)]
    walls += [plane([x, 0, 0], [-x, 0, 0], "matte") for x in (-1, 1)]
    lamps = [sphere([0, 0.8, -1 - 2 * i], 0.1, "lamp") for i in range(8)]
    corridor = scene_of([*walls, *lamps], LAMPS)
    near = rendered(corridor, context, 64, bounces=2)
    monkeypatch.setattr(needs, "MOST_NEAR", 1)
    by_table = rendered(corridor, context, 64, bounces=2)
    assert near.error is not None
    assert by_table.error is not None
    assert near.error < 0.65 * by_table.error
