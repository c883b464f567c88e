"""The three methods share one mean: on every scene that comes with glrt, and where it is hard."""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest

from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.plan.facts import SceneFacts
from glrt.plan.features import needs_of
from glrt.scene.scene import Scene
from glrt.scene.scenefile.catalog import scene_names
from glrt.settings import settings_for
from tests.support.builders import quad, scene_of, sphere
from tests.support.hard_scenes import BALL, CEILING, FLOOR, HARD, MATERIALS, Samples, hard_scene
from tests.support.renders import METHODS, assert_agree, rendered


class Rare(NamedTuple):
    """A method that seldom finds the light of a scene."""

    method: str
    times: int  # the samples that it takes, in samples of other scenes
    loose: float  # the width that it is held to, in widths of other scenes


def methods_agree(
    scene: Scene,
    context: Context,
    samples: Samples,
    within: float,
    rare: Rare | None = None,
    **settings: Any,
) -> None:
    """`naive` and `nee` each have the mean of `mis`, with a half interval of `within` x mean."""
    counts = dict(zip(METHODS, samples, strict=True))
    widths = dict.fromkeys(METHODS, within)
    if rare:
        counts[rare.method] *= rare.times
        widths[rare.method] *= rare.loose
    pictures = {
        method: rendered(scene, context, counts[method], method=method, seed=seed, **settings)
        for seed, method in enumerate(METHODS)
    }
    for method in ("naive", "nee"):
        assert_agree(pictures[method], pictures["mis"], widths[method])


@pytest.mark.slow
@pytest.mark.parametrize("name", HARD)
def test_methods_agree_where_it_is_hard(context: Context, name: str) -> None:
    methods_agree(hard_scene(name), context, HARD[name][1], 0.05, width=32, height=32)


@pytest.mark.slow
@pytest.mark.parametrize("name", HARD)
def test_methods_agree_closely_where_it_is_hard(context: Context, name: str) -> None:
    samples = HARD[name][1].times(16)
    methods_agree(hard_scene(name), context, samples, 0.02, width=32, height=32)


def sampled(name: str) -> set[str]:
    """The lights that `mis` samples in the scene: its lamps, its sun, its sky."""
    scene = load(name)
    needs = needs_of(SceneFacts(scene), settings_for(scene.render, method="mis"))
    found = {"lamps": needs.sample_lights, "sun": needs.sample_sun, "sky": needs.sample_sky}
    return {source for source, is_sampled in found.items() if is_sampled}


LIT = [name for name in scene_names() if "lamps" in sampled(name) and "sun" not in sampled(name)]
SUNNY = [name for name in scene_names() if "sun" in sampled(name)]
UNLIT = [name for name in scene_names() if not sampled(name)]


RARE = {
    "stage": Rare("naive", 32, 5),  # small lamps
    "shading": Rare("naive", 8, 5),  # the same
    "cradle": Rare("nee", 8, 5),  # polished steel, whose lobe a sample of a lamp seldom meets
}


def small(name: str, height: int) -> dict[str, int]:
    """The frame of a scene file at another height, in whole blocks of 8 pixels."""
    wish = load(name).render
    return {"width": round(height * wish.width / wish.height / 8) * 8, "height": height}


@pytest.mark.slow
@pytest.mark.slow_cases("stage", "spot", "water", "frosted", "gloss", "table", "lamps", "lens")
@pytest.mark.parametrize("name", LIT)
def test_methods_agree_on_scene_files(context: Context, name: str) -> None:
    """Blocks grow until the caustics, the rarest hits, stop ruling them."""
    samples = Samples(naive=2048, nee=4096, mis=1024)  # nee suffers from polished metal
    methods_agree(load(name), context, samples, 0.05, RARE.get(name), **small(name, 16))


@pytest.mark.slow
@pytest.mark.parametrize("name", LIT)
def test_methods_agree_closely_on_scene_files(context: Context, name: str) -> None:
    """So does nee on cornell: its lamp hangs a thousandth of the room below the ceiling."""
    more = 3 if name == "table" else 1  # its glasses throw caustics
    samples = Samples(naive=8192, nee=8192, mis=4096).times(more)
    methods_agree(load(name), context, samples, 0.015, RARE.get(name), **small(name, 32))


@pytest.mark.slow
@pytest.mark.parametrize("name", SUNNY)
def test_methods_agree_under_a_sun(context: Context, name: str) -> None:
    """The test omits `naive`: it meets a sun of half a degree once in 100,000 directions."""
    nee, mis = (
        rendered(load(name), context, 1024, method=method, seed=seed, **small(name, 16))
        for seed, method in enumerate(("nee", "mis"))
    )
    assert_agree(nee, mis, 0.05)


@pytest.mark.parametrize("name", UNLIT)
def test_methods_are_one_without_lamps(context: Context, name: str) -> None:
    pictures = [
        rendered(load(name), context, 2, method=method, **small(name, 16)).radiance
        for method in METHODS
    ]
    assert np.array_equal(pictures[0], pictures[1])
    assert np.array_equal(pictures[0], pictures[2])


@pytest.mark.parametrize("method", ["nee", "mis"])
def test_two_lamps_light_as_much_as_both_alone(context: Context, method: str) -> None:
    """One of them sixty times as strong."""
    objects = [FLOOR, BALL, CEILING, sphere([-0.9, 0.2, -2.8], 0.2, "cold")]
    both = {"warm": 4.0, "cold": 1.0}
    settings = {"method": method, "bounces": 4, "width": 32, "height": 32}
    pictures = [
        rendered(scene_of(objects, MATERIALS, lights=lights), context, 128, seed=seed, **settings)
        for seed, lights in enumerate([both, {**both, "cold": 0.0}, {**both, "warm": 0.0}])
    ]
    together, warm, cold = pictures
    total = replace(
        warm,
        radiance=warm.radiance + cold.radiance,
        stderr=np.hypot(warm.stderr, cold.stderr),
    )
    assert_agree(together, total, within=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["nee", "mis"])
def test_a_lamp_cut_in_four_is_one_lamp(context: Context, method: str) -> None:
    corner, u, v = np.array([-0.7, 1.2, -3.5]), np.array([1.4, 0, 0]), np.array([0, 0, 1.2])
    settings = {"method": method, "bounces": 4, "width": 32, "height": 32}
    quarters = [
        quad((corner + i * u / 2 + j * v / 2).tolist(), list(u / 2), list(v / 2), "warm")
        for i in (0, 1)
        for j in (0, 1)
    ]
    whole_lamp, cut = (
        rendered(
            scene_of([FLOOR, BALL, *lamps], MATERIALS), context, 128, seed=len(lamps), **settings
        )
        for lamps in ([CEILING], quarters)
    )
    assert_agree(cut, whole_lamp, within=0.05)
