"""Temporal antialiasing: weights in closed form, limits against a twin, and pictures of walls."""

import math
from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.analysis.motion.playing import read_texture
from glrt.gpu.context import Context
from glrt.gpu.evaluate import Probe
from glrt.rendering.history.history_filter import Fresh
from glrt.rendering.history.taa import ANY, Taa, TaaOptions
from glrt.rendering.history.temporal import Temporal, Way
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.rendering.history.twins import Array, effective_samples, taa_shown, taa_weights
from tests.rendering.history.views import views
from tests.support.images import same_bits
from tests.support.moving import drawn, noise, two_walls, view, wall

SIZE = (16, 12)
PIXEL = 1.0 / SIZE[1]
SKY: dict[str, Any] = {"background": {"bottom": [0.1, 0.2, 0.3], "top": [3.0, 2.0, 1.0]}}
RECURSION = """
float weight_of(int one, int frames, float old) {
    vec4 known = vec4(vec3(one == 0 ? 1.0 : 0.0), old);
    for (int frame = 1; frame < frames; frame += 1) {
        known = blended(known, vec3(frame == one ? 1.0 : 0.0), 1.0, 0.1);
    }
    return known.r;
}
"""


def weights_of(gl: moderngl.Context, frames: int, old: float) -> Array:
    """The weight of each frame in the last; `old`: the samples that the first one stands for."""
    files = ["temporal/taa.glsl"]
    probe = Probe("weight_of(one, frames, old)", functions=RECURSION, includes=files)
    given = {"frames": np.full(frames, frames), "old": np.full(frames, old, np.float32)}
    return probe.run(gl, {"one": np.arange(frames), **given})


# --- weights ------------------------------------------------------------------------------------


@pytest.mark.parametrize(("frames", "published"), [(5, 2.17), (10, 5.13), (15, 9.78), (200, 19.0)])
def test_an_exponential_mean_has_the_published_number_of_samples(
    ctx: moderngl.Context, frames: int, published: float
) -> None:
    """1 / sum of squared weights (Yang et al. 2020, figure 4); (2 - a) / a in the end."""
    weights = weights_of(ctx, frames, 1e9)
    assert weights.sum() == pytest.approx(1, abs=1e-5)
    found = 1 / float(np.square(weights, dtype=float).sum())
    assert found == pytest.approx(published, rel=1e-3)
    assert found == pytest.approx(effective_samples(frames, 0.1), rel=1e-4)


@pytest.mark.parametrize("frames", [2, 5, 10])
def test_the_first_views_count_the_same(ctx: moderngl.Context, frames: int) -> None:
    """1 / n until that is the least share: as accumulation."""
    assert weights_of(ctx, frames, 1.0) == pytest.approx(np.full(frames, 1 / frames), abs=1e-6)


def test_later_ones_forget(ctx: moderngl.Context) -> None:
    """The number of samples is first that of the mean, then that of the exponential mean."""
    assert weights_of(ctx, 40, 1.0) == pytest.approx(taa_weights(40, 0.1), abs=1e-6)
    assert 1 / np.square(taa_weights(400, 0.1)).sum() == pytest.approx(19.0, rel=1e-3)


def test_samples_of_one_view_count_as_so_many_frames(ctx: moderngl.Context) -> None:
    files = ["temporal/taa.glsl"]
    counts = np.array([1, 2, 5, 30], np.float32)
    found = Probe("share_of(count, 1000.0, 0.1)", includes=files).run(ctx, {"count": counts})
    assert found == pytest.approx(1 - 0.9**counts, abs=1e-6)


def screens(options: TaaOptions, scenes: list[Scene], context: Context) -> tuple[Array, Array]:
    """The pictures shown of views of one sample each, and the films: both (frames, H, W, 3)."""
    size = {"width": SIZE[0], "height": SIZE[1], "sampler": "independent"}
    renderer = Renderer(scenes[0], settings_for(scenes[0].render, **size), context)
    temporal = Temporal(context.gl, Way("taa"))
    temporal._resolver = Taa(context.gl, options)
    shown, films = [], []
    for picture in views(renderer, temporal, scenes):
        shown.append(picture)
        films.append(renderer.image().radiance)
    temporal.release()
    renderer.release()
    return np.array(shown), np.array(films)


def test_a_still_view_is_the_mean_that_the_weights_say(context: Context) -> None:
    """Its variance therefore falls as 1 / sum of squared weights."""
    shown, films = screens(TaaOptions(reach=ANY), [wall(**SKY)] * 15, context)
    mean = np.einsum("n,nhwc->hwc", taa_weights(15, 0.1), films)
    np.testing.assert_allclose(shown[-1], mean, rtol=2e-5)
    np.testing.assert_allclose(shown[9], films[:10].mean(axis=0), rtol=1e-5)


def test_a_share_of_one_is_the_film(context: Context) -> None:
    shown, films = screens(TaaOptions(least=1.0), [wall(**SKY)] * 3, context)
    np.testing.assert_allclose(shown, films, rtol=1e-6)


# --- limits -------------------------------------------------------------------------------------


def test_colours_survive_the_way_to_their_axes(ctx: moderngl.Context) -> None:
    colors = np.random.default_rng(1).gamma(1, 1, (100, 3)).astype(np.float32)
    probe = Probe("rgb_of(ycocg_of(color))", "vec3", includes=["temporal/taa.glsl"])
    assert probe.run(ctx, {"color": colors}) == pytest.approx(colors, rel=1e-5, abs=1e-6)
    grey = Probe("ycocg_of(vec3(0.3))", "vec3", includes=["temporal/taa.glsl"]).run(ctx)
    assert grey[0] == pytest.approx([0.3, 0, 0], abs=1e-7)


def test_history_is_brought_to_the_edge_of_the_box_on_its_way_to_the_middle(
    ctx: moderngl.Context,
) -> None:
    rng = np.random.default_rng(2)
    color, middle, reach = (rng.normal(0, 1, (300, 3)).astype(np.float32) for _ in range(3))
    reach = np.abs(reach)
    inputs = {"color": color, "middle": middle, "reach": reach}
    probe = Probe("clipped(color, middle, reach)", "vec3", includes=["temporal/taa.glsl"])
    found = probe.run(ctx, inputs)
    off, left = color - middle, found - middle
    is_inside = (np.abs(off) <= reach).all(axis=1)
    assert 20 < is_inside.sum() < 280
    assert found[is_inside] == pytest.approx(color[is_inside], rel=1e-5, abs=1e-6)
    largest = (np.abs(left) / reach).max(axis=1)[~is_inside]
    assert largest == pytest.approx(np.ones(len(largest)), rel=1e-4)
    assert np.cross(off, left) == pytest.approx(np.zeros_like(off), abs=1e-5)
    assert ((off * left).sum(axis=1) >= 0).all()


@pytest.mark.parametrize("reach", [1.0, ANY])
def test_the_pass_does_what_the_twin_does(context: Context, reach: float) -> None:
    """This holds also where there is no history, and at the edges of the picture."""
    light, mean, history = noise(SIZE, 1), noise(SIZE, 2), noise(SIZE, 3)
    history[..., :3] *= 2
    history[:3, :, 3] = 0
    arrays = {"light": light, "mean": mean, "brought": history}
    values = {"has_history": True, "least": 0.1, "reach": reach}
    found = drawn("taa.frag", arrays, values, SIZE, context)
    limit = None if reach < 0 else reach
    truth = taa_shown(light[..., :3], mean[..., 3], history, 0.1, limit)
    np.testing.assert_allclose(found, truth, rtol=1e-4, atol=1e-5)
    alone = drawn("taa.frag", arrays, {**values, "has_history": False}, SIZE, context)
    assert np.array_equal(alone, np.dstack([light[..., :3], mean[..., 3:]]))


# --- motion -------------------------------------------------------------------------------------


def test_a_pan_by_whole_pixels_keeps_history_exactly(context: Context) -> None:
    """A place in both views shows both samples; one that comes into sight shows its own alone."""
    scenes = [wall(**SKY), wall(2 * PIXEL, **SKY)]
    shown, films = screens(TaaOptions(reach=ANY), scenes, context)
    np.testing.assert_allclose(
        shown[1][:, :-2], (films[0][:, 2:] + films[1][:, :-2]) / 2, rtol=1e-5
    )
    assert same_bits(shown[1][:, -2:], films[1][:, -2:])


def test_what_was_hidden_shows_its_own_sample_in_a_band_as_wide_as_the_parallax(
    context: Context,
) -> None:
    """A quad goes left by 4 pixels, the wall behind it by 2: no ghost is left in between."""
    scenes = [two_walls(0.0, **SKY), two_walls(2 * PIXEL, **SKY)]
    shown, films = screens(TaaOptions(), scenes, context)
    is_fresh = (shown[1] == films[1]).all(axis=(0, 2))
    edge = SIZE[0] // 2 - 4
    assert is_fresh[edge : edge + 2].all()
    assert not is_fresh[: edge - 1].any()
    assert not is_fresh[edge + 4 : -3].any()  # pixels at an edge give theirs to such alone
    assert is_fresh[-2:].all()


def test_half_a_pixel_a_hundred_times_keeps_detail(context: Context) -> None:
    """A wave of 8 pixels on a wall, to and fro: what the response of the spline leaves of it."""
    waves, turns, size = 2 * math.pi / 8, 100, (64, 16)
    x = np.arange(64) + 0.5
    picture = np.ones((16, 64, 4), np.float32)
    picture[..., 0] = 1 + np.sin(waves * x)
    taa = Taa(context.gl)
    with (
        view(wall(), context, size) as here,
        view(wall(0.5 / 16), context, size) as there,
        context.gl,
    ):
        seen = context.gl.texture(size, 4, picture.tobytes(), dtype="f4")
        none = context.gl.texture(size, 4, bytes(16 * 64 * 16), dtype="f4")
        taa.arrive(here, None, True)
        taa.show(here, Fresh(seen, seen, 1, 64.0))
        places = [here, there]
        for turn in range(1, turns + 1):
            taa.arrive(places[turn % 2], places[1 - turn % 2], True)
            shown = taa.show(places[turn % 2], Fresh(none, none, 1, 64.0))
        history = read_texture(shown).copy()
        for part in (seen, none, taa):
            part.release()
    gain = 9 / 8 * math.cos(waves / 2) - 1 / 8 * math.cos(3 * waves / 2)
    inner = slice(24, 40)  # two waves, away from what has come into sight
    amplitude = 2 * np.mean((history[8, inner, 0] - 1) * np.sin(waves * x[inner]))
    assert amplitude == pytest.approx(gain**turns, abs=0.005)
    assert amplitude > 0.4  # linear interpolation leaves 0.0004


def test_history_far_from_what_is_seen_now_is_brought_near(context: Context) -> None:
    """A wall becomes three times as bright, evenly: no ghost of the dim one, after one sample."""
    bright: dict[str, Any] = {"background": {"color": [3.0, 3.0, 3.0]}}
    shown, films = screens(TaaOptions(), [wall()] * 6 + [wall(**bright)], context)
    np.testing.assert_allclose(shown[-1], films[-1], rtol=1e-5)
    ghost, _ = screens(TaaOptions(reach=ANY), [wall()] * 6 + [wall(**bright)], context)
    assert ghost[-1].mean() < 0.5 * films[-1].mean()
