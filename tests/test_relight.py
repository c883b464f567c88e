"""Light changed without a new render equals a fresh one: to the bit, or up to noise."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.again import open_renderer
from glrt.context import Context
from glrt.image import Image, Pixels
from glrt.library import load_recipe, recipe_of
from glrt.relight import (
    MOST_LAYERS,
    NONE,
    ONE,
    Layering,
    Weights,
    emitters,
    layer_of_group,
    plan_for,
)
from glrt.renderer import Renderer
from glrt.scene import Background, Light, Scene, with_lights
from glrt.settings import Cost, settings_for
from glrt.stats import block_means, z_test
from glrt.ui.controls import replaced
from tests.builders import MATTE, lamp, quad, room_of_planes, scene_of, sphere
from tests.images import same_bits

LAMPS = {
    "warm": {"type": "light", "emission": [4.0, 2.0, 0.5]},
    "cold": {"type": "light", "emission": [0.5, 1.0, 6.0]},
}
ROOM = [
    *room_of_planes("white"),
    sphere([0.4, -0.6, -0.4], 0.4, "white"),
    quad([-0.9, 0.9, -0.9], [0.5, 0, 0], [0, 0, 0.5], "warm"),
]
OTHER = quad([0.4, 0.9, -0.9], [0.5, 0, 0], [0, 0, 0.5], "cold")


def room(lamps: int = 1, sky: float = 0.0, **lights: float) -> Scene:
    """A closed room with one lamp or two; a sky is seen through the missing wall behind."""
    objects = [*ROOM, OTHER] if lamps > 1 else ROOM
    objects = objects[:5] + objects[6:] if sky else objects
    names = ["warm", "cold"][:lamps]
    materials = {"white": MATTE, **{name: LAMPS[name] for name in names}}
    background = {"background": {"color": [sky, sky, 2 * sky]}} if sky else {}
    return scene_of(objects, materials, lights=lights, **background)


@contextmanager
def layered(
    scene: Scene, context: Context, layering: Layering = "groups", **settings: Any
) -> Iterator[Renderer]:
    size = {"width": 16, "height": 16, "bounces": 4, **settings}
    renderer = Renderer(scene, context=context, layering=layering, **size)
    try:
        yield renderer
    finally:
        renderer.release()


def radiance(renderer: Renderer) -> Pixels:
    return renderer.image().radiance


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


def tinted(scene: Scene, name: str, emission: tuple[float, float, float]) -> Scene:
    material = scene.materials[name]
    assert isinstance(material, Light)
    return replaced(
        scene, materials={**scene.materials, name: replaced(material, emission=emission)}
    )


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


@pytest.mark.parametrize("sampler", ["independent", "sobol"])
@pytest.mark.parametrize("sky", [0.0, 0.5])
def test_groups_weighed_anew_equal_a_fresh_render_up_to_noise(
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
        monkeypatch.setattr("glrt.film.BAND_PIXELS", 7 * renderer.size[0])
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


def test_more_groups_than_layers_share_the_last(context: Context) -> None:
    names = [f"lamp {n}" for n in range(8)]
    balls = [sphere([0.2 * n - 0.8, 0.5, -0.5], 0.05, name) for n, name in enumerate(names)]
    materials = {"white": MATTE, **{name: lamp(3.0) for name in names}}
    scene = scene_of([*room_of_planes("white"), *balls], materials)
    layers = layer_of_group(scene)
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
    assert list(emitters(room(2))) == ["warm", "cold"]
    assert list(emitters(room(1, 0.5))) == ["warm", "background"]
    assert list(emitters(tinted(room(2), "cold", NONE))) == ["warm", "cold"]


# --- path lengths -----------------------------------------------------------------------


@pytest.mark.parametrize("limit", [0, 1, 2, 3])
def test_fewer_bounces_equal_a_fresh_render_to_rounding(context: Context, limit: int) -> None:
    with (
        layered(room(2, 0.5), context, "lengths", roulette=False) as renderer,
        layered(room(2, 0.5), context, "none", bounces=limit, roulette=False) as fresh,
    ):
        renderer.render(16)
        assert renderer.update(bounces=limit) is Cost.RELIGHT
        assert np.allclose(radiance(renderer), radiance(fresh.render(16)), rtol=1e-5, atol=1e-6)
        assert renderer.update(bounces=4) is Cost.RELIGHT


def test_the_light_of_each_length_adds_up(context: Context) -> None:
    with layered(room(), context, "lengths", bounces=9) as renderer:
        assert renderer.plan.layers == MOST_LAYERS
        renderer.render(8)
        parts = [seen(renderer, renderer.plan.alone(length)) for length in range(MOST_LAYERS)]
        assert np.allclose(sum(parts), radiance(renderer), rtol=1e-4, atol=1e-6)
        assert all(part.any() for part in parts[1:]), "the camera does not see the lamp"
        assert renderer.plan.alone(8) == renderer.plan.alone(5), "the last layer holds the rest"


@pytest.mark.parametrize(("limit", "cost"), [(4, Cost.RELIGHT), (5, Cost.RESTART), (10, None)])
def test_a_limit_within_the_last_layer_restarts(
    context: Context, limit: int, cost: Cost | None
) -> None:
    with layered(room(), context, "lengths", bounces=10) as renderer:
        renderer.render(1)
        assert renderer.update(bounces=limit) is cost


def test_more_bounces_than_traced_restart(context: Context) -> None:
    with layered(room(), context, "lengths", bounces=3) as renderer:
        renderer.render(1)
        assert renderer.update(bounces=4) in (Cost.RESTART, Cost.RECOMPILE)


def test_turning_layers_on_and_off_begins_anew(context: Context) -> None:
    with layered(room(2), context, "none") as renderer:
        renderer.render(4)
        assert renderer.update(layering="lengths") is Cost.RECOMPILE
        renderer.render(4)
        assert renderer.update(layering="groups") is Cost.RECOMPILE
        assert renderer.update(layering="groups") is None


# --- on the driver ----------------------------------------------------------------------


def seen(renderer: Renderer, weights: Weights) -> Pixels:
    """The texture that the display pass gets."""
    with renderer.context.gl:
        texture: moderngl.Texture = renderer.weighed(weights)
        width, height = texture.size
        return np.frombuffer(texture.read(), np.float32).reshape(height, width, 4)[..., :3].copy()


def test_the_driver_shows_the_sum_that_files_hold(context: Context) -> None:
    """Of an odd number of samples: one half of them has more than the other."""
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
    plan = plan_for(scene, settings_for(scene.render), "groups")
    assert plan.weights == (ONE,)
    assert plan.relit(scene, plan.settings, "groups") == plan


# --- recipes ----------------------------------------------------------------------------


def rendered_again(picture: Path, context: Context, **options: Any) -> Image:
    """What `glrt render` makes of a picture."""
    scene, settings = load_recipe(picture)
    assert settings
    settings = settings_for(settings, **options)
    renderer = open_renderer(scene, settings, recipe_of(picture), context, "baked")
    try:
        return renderer.render().image()
    finally:
        renderer.release()


def saved(renderer: Renderer, folder: Path, weights: Weights | None = None) -> tuple[Image, Path]:
    image, file = renderer.image(weights), folder / "relit.exr"
    image.save(file)
    return image, file


@pytest.mark.parametrize("lights", [{"warm": 0.3}, {"warm": 0.0, "cold": 1.7}, {"cold": 0.0}])
def test_a_relit_picture_comes_out_of_its_recipe_to_the_bit(
    context: Context, tmp_path: Path, lights: dict[str, float]
) -> None:
    with layered(room(2, warm=0.7, cold=0.0), context) as renderer:
        renderer.render(12)
        relit = tinted(with_lights(renderer.scene, lights), "warm", (3.0, 0.7, 0.5))
        assert renderer.update(relit) is Cost.RELIGHT
        image, file = saved(renderer, tmp_path)
    again = rendered_again(file, context)
    assert same_bits(again.radiance, image.radiance)
    assert same_bits(again.stderr, image.stderr)
    assert again.recipe
    assert image.recipe
    assert (again.recipe.scene, again.recipe.traced) == (relit, image.recipe.traced)
    with layered(relit, context, "none") as fresh:
        assert not same_bits(radiance(fresh.render(12)), image.radiance), "other random numbers"


def test_a_picture_of_fewer_bounces_comes_out_of_its_recipe_to_the_bit(
    context: Context, tmp_path: Path
) -> None:
    with layered(room(2, 0.5), context, "lengths") as renderer:
        renderer.render(6)
        assert renderer.update(bounces=2) is Cost.RELIGHT
        image, file = saved(renderer, tmp_path)
        again = rendered_again(file, context)
        assert same_bits(again.radiance, image.radiance)
        assert again.recipe
        assert again.recipe.settings.bounces == 2
        alone, file = saved(renderer, tmp_path, renderer.plan.alone(1))
    assert same_bits(rendered_again(file, context).radiance, alone.radiance)
    assert not same_bits(alone.radiance, image.radiance)


def test_what_is_asked_for_beside_a_relit_recipe_is_heeded(
    context: Context, tmp_path: Path
) -> None:
    with layered(room(2), context) as renderer:
        renderer.render(4)
        renderer.update(room(2, warm=0.3))
        _, file = saved(renderer, tmp_path)
    larger = rendered_again(file, context, width=20, samples=6)
    assert larger.radiance.shape == (16, 20, 3)
    assert larger.samples == 6
    more = rendered_again(file, context, bounces=7)
    with layered(room(2, warm=0.3), context, "none", bounces=7) as fresh:
        assert same_bits(more.radiance, radiance(fresh.render(4)))


def test_a_picture_that_was_not_relit_tells_its_scene_once(context: Context) -> None:
    with layered(room(2), context) as renderer:
        renderer.render(2)
        recipe = renderer.image().recipe
        assert recipe
        assert recipe.traced is None
        renderer.update(room(2, warm=0.3))
        renderer.update(room(2))
        assert renderer.image().recipe == recipe
