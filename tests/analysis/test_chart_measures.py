"""`glrt chart`: what it measures of a variant."""

import numpy as np
import pytest

from glrt.analysis.chart.experiment import Plan
from glrt.analysis.chart.measure import Bench, of_variant
from glrt.analysis.chart.rays import rays_of
from glrt.analysis.reference import Reference
from glrt.analysis.variants import Variant, variants_of
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.settings import settings_for
from tests.support.builders import box_of_quads, lamp, scene_of, sphere

NAMES = "ddgi, live probes", "ddgi, sobol"


@pytest.mark.slow
def test_rays_are_counted(context: Context) -> None:
    walls = {"wall": {"type": "lambertian", "color": [0.5] * 3}, "lamp": lamp()}
    room = scene_of(box_of_quads("wall", 2.0), walls)
    rays = {
        bounces: rays_of(
            room,
            settings_for(room.render, width=8, height=8, bounces=bounces, roulette=False),
            context,
        ).sample
        for bounces in (0, 1, 5)
    }
    assert rays == {0: 1.0, 1: 2.0, 5: 6.0}
    lit = scene_of([*box_of_quads("wall", 2.0), sphere([0, 0, -1], 0.01, "lamp")], walls)
    settings = settings_for(lit.render, width=8, height=8, bounces=1, method="nee")
    shadowed = rays_of(lit, settings, context).sample
    assert 2.9 < shadowed <= 3.0, "camera, shadow and scattered ray, but for the pixels of the lamp"


def test_order_changes_from_round_to_round_and_seeds_too(context: Context) -> None:
    scene = load("methods/diffuse")
    settings = settings_for(scene.render, width=8, height=8)
    variants = variants_of(scene, settings, ["naive", "nee"], leads=False)
    truth = np.ones((8, 8, 3))
    bench = Bench(scene, variants, Reference(truth, truth, 1, 1), context)
    rounds = [list(bench.round(number, 0.01))[-1] for number in range(4)]
    bench.release()
    orders = {tuple(run.variant for run in runs) for runs in rounds}
    assert orders == {("naive", "nee"), ("nee", "naive")}
    firsts = [of_variant([runs], "nee")[0].looks[0].squared_error for runs in rounds]
    assert len(set(firsts)) == 4


def test_pictures_of_a_variant_continue_one_film(context: Context) -> None:
    scene = load("methods/diffuse")
    settings = settings_for(scene.render, width=8, height=8)
    variants = variants_of(scene, settings, ["naive", "nee"], leads=False)
    truth = np.ones((8, 8, 3))
    bench = Bench(scene, variants, Reference(truth, truth, 1, 1), context)
    two = list(bench.pictures("nee", [2, 6]))
    again = list(bench.pictures("nee", [6]))
    bench.release()
    assert [picture.samples for picture in two] == [2, 6]
    assert np.array_equal(two[1].radiance, again[0].radiance)
    assert not np.array_equal(two[0].radiance, two[1].radiance)


def test_a_denoised_variant_is_judged_by_what_it_shows(context: Context) -> None:
    """From 4 samples on, two observations a half; its error at the end is not that of its noise."""
    scene = load("cornell")
    settings = settings_for(scene.render, width=16, height=16, sampler="independent")
    named = {name: settings_for(settings, denoise=name) for name in ("none", "nlm")}
    grey = np.full((16, 16, 3), 0.5)
    bench = Bench(
        scene, [Variant(*it) for it in named.items()], Reference(grey, grey, 1, 1), context
    )
    runs = {run.variant: run for run in list(bench.round(0, 0.01))[-1]}
    bench.release()
    plain, denoised = runs["none"], runs["nlm"]
    assert [look.samples for look in denoised.looks] == [4, 8, 16, 32]
    renderer = Renderer(scene, named["nlm"], context, tier="complete", seed=1)
    shown = renderer.render(32).image().denoised()
    renderer.release()
    assert shown.noise is not None
    squared = Reference(grey, grey, 1, 1).squared_error(shown.radiance)
    assert denoised.looks[-1].squared_error == squared != plain.looks[-1].squared_error
    noise = Reference(grey, grey, 1, 1).relative(np.square(shown.noise, dtype=np.float64))
    assert denoised.squared_bias == squared - noise


@pytest.mark.slow
def test_live_probes_settle_before_each_picture_and_are_updated_once_in_it(
    context: Context,
) -> None:
    """Their light is near that of probes of their own, and one update costs fewer rays."""
    scene = load("methods/diffuse")
    plan = Plan(16, 2, 0.5, ("ddgi, live probes",))
    live, own = ([it for it in plan.variants(scene) if it.name == name] for name in NAMES)
    truth = np.ones((16, 16, 3))
    bench = Bench(scene, [*live, *own], Reference(truth, truth, 1, 1), context)
    rounds = [list(bench.round(number, 0.2))[-1] for number in range(2)]
    bench.release()
    errors = {
        name: [run.looks[-1].squared_error for run in of_variant(rounds, name)] for name in NAMES
    }
    assert errors[NAMES[0]] == pytest.approx(errors[NAMES[1]], rel=0.05)
    assert len({*errors[NAMES[0]]}) == 2, "another update for each round"
    rays = rays_of(scene, own[0].settings, context)
    assert 0 < rays.of_update() < rays.set / 8
