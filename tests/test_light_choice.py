"""The choice of a lamp: the alias table is exact, and lamps are weighed by their flux."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from glrt.pack import alias_table, light_probabilities, pack_scene
from tests.builders import scene_of, sphere
from tests.conftest import CallGlsl
from tests.numerics import BELOW_ONE, Array
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
    index = call_glsl("choose_light(u)", "int", scene=MANY, u=u)
    frequency = np.bincount(index, minlength=len(lights)) / len(u)
    assert_allclose(frequency, lights["probability"], atol=1e-5)


def test_the_choice_stays_within_the_lamps_at_the_ends(call_glsl: CallGlsl) -> None:
    random = np.random.default_rng(4)
    balls = [sphere(place, 0.01, "lamp") for place in random.uniform(-9, 9, (999, 3))]
    scene = scene_of(balls, LAMPS, render={"bounces": 1})
    u = np.concatenate([np.arange(999) / 999, [BELOW_ONE, 2.0**-24], random.uniform(size=10_000)])
    index = call_glsl("choose_light(u)", "int", scene=scene, u=np.minimum(u, BELOW_ONE))
    assert index.min() >= 0
    assert index.max() == 998
