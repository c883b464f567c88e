"""Adaptive temporal antialiasing: rules and filter against twins, and where pictures are traced."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np
import pytest

from glrt.analysis.motion.playing import read_texture
from glrt.core.errors import RenderError
from glrt.gpu.context import Context, Pipeline
from glrt.gpu.evaluate import Probe
from glrt.plan.plan import Layering
from glrt.rendering.history.ataa import OTHER_SEED, Ataa
from glrt.rendering.history.temporal import Temporal, Way
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.rendering.history.ataa_twin import failure, fxaa
from tests.rendering.history.twins import Array
from tests.rendering.history.views import views
from tests.support.builders import MATTE, lamp, plane, quad, scene_of, sphere
from tests.support.images import same_bits
from tests.support.moving import FOV, drawn, noise, two_walls, wall

SIZE = (16, 12)
PIXEL = 1.0 / SIZE[1]
SKY: dict[str, Any] = {"background": {"bottom": [0.1, 0.2, 0.3], "top": [3.0, 2.0, 1.0]}}
FILES = ["temporal/ataa.glsl"]
SAMPLES = 4


class Seen(NamedTuple):
    """The picture, the film and the mask of a view, and how many pixels were traced."""

    shown: Array  # (H, W, 3)
    film: Array
    mask: Array  # (H, W), of the first view 0
    traced: int
    settings: Any


def played(
    scenes: list[Scene],
    context: Context,
    pipeline: Pipeline = "auto",
    layering: Layering = "none",
    **more: Any,
) -> list[Seen]:
    """Views of a sample each."""
    options = {"width": SIZE[0], "height": SIZE[1], "sampler": "independent", **more}
    settings = settings_for(scenes[0].render, **options)
    renderer = Renderer(scenes[0], settings, context, pipeline=pipeline, layering=layering)
    temporal, ataa = Temporal(context.gl, Way("ataa")), Ataa(context.gl, SAMPLES)
    temporal._resolver = ataa
    seen = []
    try:
        for shown in views(renderer, temporal, scenes):
            mask = np.zeros(SIZE[::-1])
            if ataa.mask:
                with context.gl:
                    mask = read_texture(ataa.mask)[..., 3].copy()
            film = renderer.image().radiance
            seen.append(Seen(shown, film, mask, ataa.traced, renderer.settings))
    finally:
        temporal.release()
        renderer.release()
    return seen


@contextmanager
def sampled(scene: Scene, settings: Any, context: Context) -> Iterator[Array]:
    """The samples that pixels of a mask are traced by, as a film of their own seed has them."""
    renderer = Renderer(scene, settings, context, seed=settings.seed ^ OTHER_SEED)
    yield renderer.render(SAMPLES).image().radiance
    renderer.release()


# --- rules and filter -----------------------------------------------------------------------------


def test_the_first_rule_that_fires_decides(context: Context) -> None:
    """All rules, and both sides of their thresholds."""
    rng = np.random.default_rng(1)
    n = 4000
    place = rng.choice([-1.0, 0.1, 0.2, 0.3, 2.0], (n, 2))
    place[:, 1] = np.abs(place[:, 1])
    numbers = {
        "known": rng.choice([0.0, 1.0, 7.9, 8.0, 40.0], n),
        "off": rng.choice([0.0, 0.09, 0.11, 1.0], n),
        "contrast": rng.choice([0.0, 0.24, 0.26, 1.0], n),
        "edge": rng.integers(0, 2, n).astype(float),
        "mirror": rng.integers(0, 2, n).astype(float),
    }
    inputs = {name: value.astype(np.float32) for name, value in numbers.items()}
    call = "float(failure_of(vec2(0.0), place, known, off, contrast, edge > 0.5, mirror > 0.5))"
    with context.gl:
        found = Probe(call, includes=FILES).run(
            context.gl, {"place": place.astype(np.float32), **inputs}
        )
    flags = numbers.pop("edge") > 0.5, numbers.pop("mirror") > 0.5
    truth = failure(
        place, numbers["known"], numbers["off"], numbers["contrast"], flags[0], flags[1]
    )
    assert set(truth) == {0, 1, 2, 3}
    assert np.array_equal(found, truth)


def masked(light: Array, number: int, context: Context) -> Array:
    mask = np.full((*light.shape[:2], 4), number, np.float32)
    more = noise(light.shape[1::-1], 9)
    arrays = {"light": light, "mean": light, "plain": noise(light.shape[1::-1], 8), "mask": mask}
    values = {"has_more": True, "least": 0.1}
    return drawn("ataa.frag", {**arrays, "more": more}, values, light.shape[1::-1], context)


def test_the_filter_does_what_the_twin_does(context: Context) -> None:
    """The test filters noise and a slanted edge of some width."""
    y, x = np.mgrid[: SIZE[1], : SIZE[0]]
    edge = np.clip(x - 0.4 * y - 5, 0.05, 1)[..., None] * [3.0, 1.0, 0.3, 0.0]
    for light in (noise(SIZE, 5), (edge + np.eye(4)[3]).astype(np.float32)):
        found = masked(light, 1, context)
        truth = fxaa(light[..., :3].astype(float))
        np.testing.assert_allclose(found[..., :3], truth, rtol=2e-3, atol=2e-4)
        assert np.abs(truth - light[..., :3]).max() > 0.1


def test_the_filter_leaves_what_is_even_and_what_is_straight(context: Context) -> None:
    """A step between two columns is as sharp as before; even light is not touched."""
    light = np.ones((12, 16, 4), np.float32)
    np.testing.assert_allclose(masked(light, 1, context)[..., :3], 1, rtol=1e-5)
    light[:, 8:, :3] = 0.1
    shown = masked(light, 1, context)
    np.testing.assert_allclose(shown[:, 9:, :3], 0.1, rtol=1e-4)
    np.testing.assert_allclose(shown[:, :7, :3], 1, rtol=1e-4)


def test_traced_pixels_are_the_mean_of_all_their_samples(context: Context) -> None:
    """Alone, or blended with history as so many samples; the others stay what they were."""
    light, plain, more = noise(SIZE, 5), noise(SIZE, 8), noise(SIZE, 9)
    count, extra = light[..., 3:], more[..., 3:]
    mean = (count * light[..., :3] + extra * more[..., :3]) / (count + extra)
    np.testing.assert_allclose(
        masked(light, 3, context), np.dstack([mean, count + extra]), rtol=1e-5
    )
    assert np.array_equal(masked(light, 0, context), plain)
    known = np.maximum(plain[..., 3:] - count, 0)
    share = np.maximum((count + extra) / (known + count + extra), 1 - 0.9**count)
    truth = np.where(known > 0, plain[..., :3] + share * (mean - plain[..., :3]), mean)
    np.testing.assert_allclose(masked(light, 2, context)[..., :3], truth, rtol=1e-4)


# --- pictures -------------------------------------------------------------------------------------


def test_a_pan_by_whole_pixels_filters_as_many_columns(context: Context) -> None:
    seen = played([wall(**SKY), wall(3 * PIXEL, **SKY)], context)[-1]
    assert (seen.mask[:, -3:] == 1).all()
    assert not (seen.mask[:, :-3] == 1).any()


def test_what_was_hidden_is_traced_in_a_band_as_wide_as_the_parallax(context: Context) -> None:
    """A quad goes left by 4 pixels, the wall behind it by 2; samples there come from a film."""
    scenes = [two_walls(0.0, **SKY), two_walls(2 * PIXEL, **SKY)]
    seen = played(scenes, context)[-1]
    edge = SIZE[0] // 2 - 4
    assert (seen.mask[:, edge : edge + 2] == 3).all()
    assert seen.traced == (seen.mask >= 2).sum()
    with sampled(scenes[-1], seen.settings, context) as more:
        truth = (seen.film + SAMPLES * more) / (1 + SAMPLES)
    is_alone = seen.mask == 3
    assert is_alone.sum() >= 2 * SIZE[1]
    np.testing.assert_allclose(seen.shown[is_alone], truth[is_alone], rtol=1e-5)


BALL = scene_of(
    [sphere([0, 0, 0], 0.3, "matte")],
    {"matte": MATTE},
    {"position": [0, 0, 1.0], "look_at": [0, 0, 0], "fov": FOV},
    background={"color": [1.0, 1.0, 1.0]},
)


@pytest.mark.slow
@pytest.mark.slow_cases("ddgi")
@pytest.mark.parametrize("method", ["whitted", "cook", "ddgi"])
def test_a_still_camera_traces_ever_less(context: Context, method: str) -> None:
    """Edges first, until history stands for enough samples."""
    seen = played([BALL] * 8, context, method=method, sampler="sobol")
    traced = [one.traced for one in seen]
    assert traced[1] > 10, traced
    assert max(traced[-2:]) <= 0.1 * traced[1], traced


def test_the_film_and_its_bits_are_those_of_reset(context: Context) -> None:
    scenes = [two_walls(0.0, **SKY), two_walls(2 * PIXEL, **SKY)]
    seen = played(scenes, context)[-1]
    assert seen.traced
    alone = Renderer(scenes[-1], seen.settings, context)
    assert same_bits(seen.film, alone.render(1).image().radiance)
    alone.release()


@pytest.mark.slow
def test_other_weights_trace_nothing(context: Context) -> None:
    """Samples are summed under the weights of the scene; particles come from elsewhere."""
    materials = {"matte": MATTE, "lamp": lamp(4.0)}
    objects = [quad([-1, 2, 0], [2, 0, 0], [0, 0, 2], "lamp"), plane([0, 0, 0], [0, 0, 1], "matte")]
    shade = quad([-3, -3, 0.5], [3, 0, 0], [0, 6, 0], "matte")
    scenes = [
        scene_of(
            [*objects, shade],
            materials,
            {"position": [x, 0.0, 1.0], "look_at": [x, 0.0, 0.0], "fov": FOV},
        )
        for x in (0.0, 2 * PIXEL)
    ]
    seen = played(scenes, context, caustics="on", method="mis", bounces=3)
    assert seen[-1].traced == 0
    assert (seen[-1].mask >= 2).any()


@pytest.mark.slow
def test_the_fragment_pipeline_is_refused_by_name(context: Context) -> None:
    with pytest.raises(RenderError, match=r"temporal ataa .* compute shaders"):
        played([wall(), wall(PIXEL)], context, pipeline="fragment")
