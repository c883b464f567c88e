"""Light changed without a new render equals a fresh one: to the bit, or up to noise."""

from typing import Any

import numpy as np
import pytest

from glrt.error.estimate import block_means
from glrt.gpu.context import Context
from glrt.plan.facts import SceneFacts
from glrt.plan.plan import (
    MOST_LAYERS,
    NONE,
    ONE,
    Layering,
    layer_of_group,
    prepare,
)
from glrt.rendering.renderer import Renderer
from glrt.scene.lights.background import Background
from glrt.scene.scene import Scene, with_lights
from glrt.settings import Cost, settings_for
from glrt.view.controls import replaced
from tests.support.builders import MATTE, lamp, room_of_planes, scene_of, sphere
from tests.support.images import same_bits
from tests.support.relit_room import layered, radiance, room, seen, tinted
from tests.support.z_scores import z_test

# --- one light group --------------------------------------------------------------------


@pytest.mark.parametrize("factor", [0.25, 2.0, 8.0])
def test_one_group_times_a_power_of_two_equals_a_fresh_render_to_the_bit(
    context: Context, factor: float
) -> None:
    relit_scene = with_lights(room(), {"warm": factor})
    with layered(room(), context) as renderer, layered(relit_scene, context) as fresh:
        assert renderer.plan.layers == 0, "one group pays for no layer"
        renderer.render(32)
        assert renderer.update(relit_scene) is Cost.RELIGHT
        assert renderer.samples == 32
        fresh.render(32)
        assert same_bits(radiance(renderer), radiance(fresh))
        assert renderer.image().error is not None
        assert same_bits(renderer.image().stderr, fresh.image().stderr)
    with layered(relit_scene, context, "none") as plain:
        assert same_bits(radiance(plain.render(8)), radiance(fresh_again(relit_scene, context)))


def fresh_again(scene: Scene, context: Context) -> Renderer:
    return Renderer(
        scene, context=context, layering="groups", width=16, height=16, bounces=4
    ).render(8)


def test_a_lamp_that_was_off_comes_back_at_once(context: Context) -> None:
    with layered(room(warm=0.0), context) as renderer, layered(room(), context) as fresh:
        renderer.render(8)
        assert not radiance(renderer).any()
        assert renderer.update(room()) is Cost.RELIGHT
        assert same_bits(radiance(renderer), radiance(fresh.render(8)))
        assert renderer.update(room(warm=0.0)) is Cost.RELIGHT
        assert not radiance(renderer).any()


def test_another_colour_of_the_only_lamp_equals_a_fresh_render_to_rounding(
    context: Context,
) -> None:
    scene = room()
    dyed = tinted(scene, "warm", (1.0, 3.0, 0.2))
    with layered(scene, context) as renderer, layered(dyed, context) as fresh:
        renderer.render(8)
        assert renderer.update(dyed) is Cost.RELIGHT
        assert np.allclose(radiance(renderer), radiance(fresh.render(8)), rtol=1e-5, atol=1e-7)


def test_light_of_a_channel_that_was_not_traced_restarts(context: Context) -> None:
    red = tinted(room(), "warm", (1.0, 0.0, 0.0))
    with layered(red, context) as renderer:
        renderer.render(2)
        assert renderer.update(room()) is Cost.RESTART
        assert renderer.samples == 0


def test_a_lamp_or_a_sky_that_did_not_shine_restarts(context: Context) -> None:
    for scene in (room(1, 0.0), tinted(room(2), "cold", NONE)):
        lit = replaced(room(2), background=Background(color=(1.0, 1.0, 1.0)))
        lit = lit if len(scene.light_groups) == 3 else replaced(scene, background=lit.background)
        with layered(scene, context) as renderer:
            renderer.render(2)
            assert renderer.update(lit) in (Cost.RESTART, Cost.RECOMPILE)
            assert renderer.update(scene) in (Cost.RESTART, Cost.RECOMPILE)


def test_lamps_made_black_cost_no_kernel(context: Context) -> None:
    with layered(room(2), context) as renderer:
        assert renderer.update(tinted(room(2), "cold", NONE)) is Cost.RELIGHT
        assert renderer.update(seed=1) is Cost.RESTART
        assert renderer.update(room(2)) is Cost.RESTART
        assert renderer.update(room(2, warm=0.0, cold=0.0)) is Cost.RELIGHT
        assert renderer.update(seed=2) is Cost.RESTART


# --- several light groups ---------------------------------------------------------------


@pytest.mark.slow_cases("0.5-independent")
@pytest.mark.parametrize("sampler", ["independent", "sobol"])
@pytest.mark.parametrize("sky", [0.0, 0.5])
def test_groups_weighed_again_equal_a_fresh_render_up_to_noise(
    context: Context, sky: float, sampler: str
) -> None:
    before, after = {"warm": 1.0, "cold": 0.0}, {"warm": 0.3, "cold": 2.5}
    if sky:
        after["background"] = 4.0
    scene = room(2, sky, **before)
    options: dict[str, Any] = {"sampler": sampler, "samples": 512}
    relit_scene = with_lights(scene, after)
    with layered(scene, context, **options) as renderer:
        assert renderer.plan.layers == (3 if sky else 2)
        renderer.render()
        assert renderer.update(relit_scene) is Cost.RELIGHT
        relit = renderer.image()
    with layered(relit_scene, context, "none", seed=1, **options) as fresh:
        truth = fresh.render().image()
    spread = np.sqrt(block_means(relit.stderr**2, 4) + block_means(truth.stderr**2, 4)) / 4
    # A false alarm in 10,000 runs; the seeds are fixed.
    assert z_test(
        block_means(relit.radiance, 4), spread, block_means(truth.radiance, 4), alpha=1e-4
    ), "relit and fresh"
    assert relit.radiance.mean() > 1.2 * fresh_mean(scene, context)


def fresh_mean(scene: Scene, context: Context) -> float:
    with layered(scene, context, "none") as renderer:
        return float(radiance(renderer.render(16)).mean())


@pytest.mark.parametrize("layering", ["none", "groups"])
def test_a_picture_read_by_bands_is_that_read_at_once(
    context: Context, monkeypatch: pytest.MonkeyPatch, layering: Layering
) -> None:
    with layered(room(2), context, layering) as renderer:
        renderer.render(33)
        renderer.update(room(2, warm=0.2) if layering == "groups" else None)
        at_once = renderer.image()
        monkeypatch.setattr("glrt.rendering.film.BAND_PIXELS", 7 * renderer.size[0])
        by_bands = renderer.image()
    assert by_bands.radiance.tobytes() == at_once.radiance.tobytes()
    assert by_bands.stderr.tobytes() == at_once.stderr.tobytes()


def test_layers_sum_up_to_the_picture(context: Context) -> None:
    with layered(room(2, 0.5), context) as renderer:
        renderer.render(32)
        with context.gl:
            film = renderer.film.read()
        halves = film.layers[..., :3].sum(axis=1)
        assert np.allclose(halves.mean(axis=0), film.mean, rtol=1e-4, atol=1e-6)
        assert (film.layers[..., 3] == 16).all()


@pytest.mark.parametrize("sampler", ["independent", "sobol"])
def test_the_error_of_a_weighted_sum_takes_two_observations(context: Context, sampler: str) -> None:
    with layered(room(2), context, sampler=sampler) as renderer:
        renderer.update(room(2, warm=0.2))
        block = renderer.settings.block
        assert renderer.render(2 * block - 1).image().error is None
        assert renderer.render(2 * block).image().error is not None


@pytest.mark.slow
@pytest.mark.parametrize("sampler", ["independent", "sobol"])
def test_the_error_of_a_weighted_sum_is_what_it_is(context: Context, sampler: str) -> None:
    """The estimate against the deviation from a render of 64 times as many samples."""
    scene, relit_scene = room(2), room(2, warm=0.2, cold=3.0)
    with layered(relit_scene, context, "none", seed=7, width=24, height=24) as fresh:
        truth = radiance(fresh.render(64 * 64))
    with layered(scene, context, width=24, height=24, sampler=sampler) as renderer:
        renderer.render(64)
        renderer.update(relit_scene)
        image = renderer.image()
    actual = np.sqrt(np.mean((image.radiance - truth) ** 2 / (truth**2 + 1e-3)))
    estimate = np.sqrt(np.mean(image.stderr**2 / (truth**2 + 1e-3)))
    assert estimate == pytest.approx(actual, rel=0.15)


def test_an_untouched_picture_is_that_of_a_render_without_layers(context: Context) -> None:
    with (
        layered(room(2, 0.5), context) as renderer,
        layered(room(2, 0.5), context, "none") as plain,
    ):
        assert same_bits(radiance(renderer.render(8)), radiance(plain.render(8)))


def test_a_film_that_was_weighed_goes_on(context: Context) -> None:
    with layered(room(2), context) as renderer, layered(room(2), context) as other:
        renderer.render(8)
        renderer.update(room(2, warm=0.5))
        renderer.render(16)
        other.render(16)
        other.update(room(2, warm=0.5))
        assert same_bits(radiance(renderer), radiance(other))


@pytest.mark.slow
def test_more_groups_than_layers_share_the_last(context: Context) -> None:
    names = [f"lamp {n}" for n in range(8)]
    balls = [sphere([0.2 * n - 0.8, 0.5, -0.5], 0.05, name) for n, name in enumerate(names)]
    materials = {"white": MATTE, **{name: lamp(3.0) for name in names}}
    scene = scene_of([*room_of_planes("white"), *balls], materials)
    layers = layer_of_group(SceneFacts(scene))
    assert [layers[name] for name in names] == [0, 1, 2, 3, 4, 5, 5, 5]
    with layered(scene, context) as renderer:
        assert renderer.plan.layers == MOST_LAYERS
        traced = radiance(renderer.render(2))
        assert renderer.update(with_lights(scene, {"lamp 0": 2.0})) is Cost.RELIGHT
        together = with_lights(scene, dict.fromkeys(names[5:], 2.0))
        assert renderer.update(together) is Cost.RELIGHT
        everything = with_lights(scene, dict.fromkeys(names, 2.0))
        assert renderer.update(everything) is Cost.RELIGHT
        assert np.allclose(radiance(renderer), 2 * traced, rtol=1e-4, atol=1e-6)
        assert renderer.update(with_lights(scene, {"lamp 7": 3.0})) is Cost.RESTART


def test_what_is_no_light_restarts(context: Context) -> None:
    with layered(room(2), context) as renderer:
        renderer.render(2)
        assert renderer.update(seed=5) is Cost.RESTART
        moved = replaced(room(2), camera=replaced(room(2).camera, fov=50.0))
        assert renderer.update(moved) is Cost.RESTART


def test_lamps_and_a_sky_that_shines_are_groups() -> None:
    assert list(SceneFacts(room(2)).emissions) == ["warm", "cold"]
    assert list(SceneFacts(room(1, 0.5)).emissions) == ["warm", "background"]
    assert list(SceneFacts(tinted(room(2), "cold", NONE)).emissions) == ["warm", "cold"]


# --- on the driver ----------------------------------------------------------------------


def test_the_driver_shows_the_sum_that_files_hold(context: Context) -> None:
    """The number of samples is odd: one half has more samples than the other."""
    with layered(room(2, 0.5), context, width=20, height=12) as renderer:
        renderer.render(3)
        renderer.update(room(2, 0.5, warm=0.2, background=3.0))
        assert np.allclose(
            seen(renderer, renderer.plan.weights), radiance(renderer), rtol=1e-5, atol=1e-7
        )
    with layered(room(), context) as single:
        single.render(3)
        single.update(room(warm=0.3))
        assert np.allclose(seen(single, single.plan.weights), radiance(single), rtol=1e-6)


def test_a_plan_without_change_weighs_nothing() -> None:
    scene = room(2)
    plan = prepare(scene, settings_for(scene.render), "groups")
    assert plan.weights == (ONE,)
    assert plan.relit(scene, plan.settings, "groups") == plan
