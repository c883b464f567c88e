"""The choice of a lamp: the alias table is exact; few lamps are weighed by flux and nearness."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.accel.light_clusters import alias_table, light_probabilities
from glrt.gpu.context import Context
from glrt.plan.facts import MOST_NEAR, SceneFacts
from glrt.plan.features import needs_of
from glrt.scene.scene import Scene
from glrt.settings import Cost, settings_for
from tests.conftest import CallGlsl
from tests.shaders.test_light import LAMPS, MANY
from tests.support.builders import scene_of, sphere
from tests.support.numerics import BELOW_ONE, Array
from tests.support.packed import packed
from tests.support.renders import rendering


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
    lights = packed(MANY)["Cluster"]
    flux = np.array([4 * np.pi * 30, np.pi * 2, np.pi / 4 * 2, 2 * 4 * 2, 0])  # area x radiance
    assert_allclose(lights["probability"], 0.1 + 0.5 * flux / flux.sum(), rtol=1e-6)


# --- few lamps -----------------------------------------------------------------------------


FROM = "Ray from = Ray(origin, vec3(0.0, 1.0, 0.0), NO_SHAPE, false);"
CHOSEN = (
    "float total = total_weight(from); int index = choose_light(from, total, vec3(u, 0.0, 0.0));"
)


def weights(scene: Scene, origin: Array) -> Array:
    """The weight of each lamp at each point, (n, lamps) float64: flux over squared distance."""
    lights = packed(scene)["Cluster"]
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
        "vec2(index, choice_pdf(index, from, total))",
        "vec2",
        setup=FROM + CHOSEN,
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
        setup = FROM + CHOSEN
        origin = np.tile([0.3, 0.1, 0.2], (2, 1))
        args = {"setup": setup, "scene": balls(count), "origin": origin, "u": u}
        assert call_glsl("index", "int", **args).tolist() == [0, count - 1]


def test_more_lamps_than_that_are_weighed_in_clusters() -> None:
    """A single lamp needs no choice; naive chooses none."""
    for count, clusters in ((1, 1), (2, 2), (MOST_NEAR, MOST_NEAR), (MOST_NEAR + 1, MOST_NEAR)):
        scene = balls(count)
        needs = needs_of(SceneFacts(scene), settings_for(scene.render))
        assert (needs.clusters, needs.many_lights) == (clusters, count > MOST_NEAR)
        needs = needs_of(SceneFacts(scene), settings_for(scene.render, method="naive"))
        assert (needs.clusters, needs.many_lights) == (0, False)


@pytest.mark.slow
def test_another_lamp_compiles_where_lamps_are_weighed(context: Context) -> None:
    """Their number is a constant of the kernel; with many lamps, the number of clusters is."""
    for count, cost in ((2, Cost.RECOMPILE), (MOST_NEAR + 1, Cost.RESTART)):
        with rendering(balls(count), context) as renderer:
            assert renderer.update(balls(count + 1)) is cost


def test_the_lamp_just_left_is_not_chosen(call_glsl: CallGlsl) -> None:
    scene, u = balls(3), (np.arange(64) + 0.5) / 64
    for left in range(3):
        setup = f"{FROM} from.origin_shape = {left}; {CHOSEN}"
        args = {"setup": setup, "origin": np.zeros((64, 3)), "u": u}
        chosen = call_glsl("index", "int", scene=scene, **args)
        assert set(chosen.tolist()) == {0, 1, 2} - {left}


def test_a_dark_lamp_keeps_its_chance(call_glsl: CallGlsl) -> None:
    """Its group may be lit again without a restart."""
    objects = [sphere([-1, 0, 0], 0.1, "lamp"), sphere([1, 0, 0], 0.1, "dark")]
    u = np.array([0.1, 0.9])
    setup = FROM + CHOSEN
    args = {"setup": setup, "origin": np.zeros((2, 3)), "u": u}
    chosen = call_glsl("index", "int", scene=scene_of(objects, LAMPS), **args)
    assert chosen.tolist() == [0, 1]
