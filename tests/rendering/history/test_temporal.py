"""Film and history on the screen: weights in closed form, and nothing that reaches the film."""

from typing import Any

import numpy as np
import pytest

from glrt.analysis.motion.playing import Played, play, screen_of
from glrt.analysis.motion.sequences import Sequence, orbit
from glrt.gpu.context import Context, Pipeline
from glrt.image.sources import load
from glrt.rendering.history.reproject import OTHER_LIGHT, Reproject
from glrt.rendering.history.temporal import END, Mode, Temporal, Way, is_lit_alike
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for
from tests.support.builders import MATTE, scene_of, sphere
from tests.support.images import same_bits
from tests.support.moving import UNLIMITED, drawn, noise, textures_of, wall

SKY: dict[str, Any] = {
    "background": {"bottom": [0.1, 0.2, 0.3], "top": [3.0, 2.0, 1.0]}
}  # noise on a wall
PIXEL = 1.0 / 12
HISTORIES: list[Mode] = ["reproject", "taa", "ataa", "wrls", "upsample"]


def settings(scene: Scene, **more: object) -> Settings:
    return settings_for(scene.render, width=16, height=12, sampler="independent", **more)


def pictures(
    scenes: tuple[Scene, ...], context: Context, mode: Mode, pipeline: Pipeline = "auto"
) -> list[np.ndarray]:
    sequence = Sequence("test", scenes)
    return [*play(sequence, Played(settings(scenes[0]), Way(mode), pipeline=pipeline), context)]


def film_of(scene: Scene, context: Context, samples: int = 1, **more: object) -> np.ndarray:
    renderer = Renderer(scene, settings(scene, **more), context)
    radiance = renderer.render(samples).image().radiance
    renderer.release()
    return radiance


def test_history_and_film_are_weighed_by_their_samples(context: Context) -> None:
    """History also fades, until the film has enough samples to be shown alone."""
    size = 16, 12
    history, light, mean = noise(size, 1), noise(size, 2), noise(size, 3)
    history[:4, :, 3] = 0
    samples, end = 6.0, 24.0
    wrong = np.zeros((2, 2, 4), np.float32)
    wrong[1, 1, 0] = 0.25
    arrays = {"light": light, "mean": mean, "brought": history, "evidence": wrong}
    shown = [
        drawn("fade.frag", arrays, {"samples": count, "end": end}, size, context)
        for count in (samples, end)
    ]
    history[8:, 8:, 3] /= 1 + 0.25 * history[8:, 8:, 3]  # 1 / (1 / samples + evidence)
    left = history[..., 3:] * (1 - samples / end)
    total = left + mean[..., 3:]
    truth = (left * history[..., :3] + mean[..., 3:] * light[..., :3]) / total
    np.testing.assert_allclose(shown[0], np.dstack([truth, total]), rtol=2e-6)
    alone = np.dstack([light[..., :3], mean[..., 3:]])
    assert np.array_equal(shown[0][:4], alone[:4])  # bit for bit where there is no history
    assert np.array_equal(shown[1], alone)


def test_views_of_the_same_place_are_shown_as_their_mean(context: Context) -> None:
    """Weights of 1 / n: what accumulation would show."""
    scene = wall(**SKY)
    renderer = Renderer(scene, settings(scene), context)
    temporal = Temporal(context.gl)
    temporal._resolver, temporal.end = Reproject(context.gl, UNLIMITED), 1e9
    for seed in range(8):
        if seed:
            temporal.leave(renderer)
            renderer.update(seed=seed)
            temporal.arrive(renderer)
        renderer.step(1)
        shown = screen_of(renderer, temporal)
    temporal.release()
    renderer.release()
    mean = np.mean([film_of(scene, context, seed=seed) for seed in range(8)], axis=0)
    np.testing.assert_allclose(shown, mean, rtol=1e-5)


def test_a_pan_by_whole_pixels_gathers_the_samples_of_each_place(context: Context) -> None:
    """A place in both views has both samples; one that comes into sight has its own alone."""
    scenes = wall(**SKY), wall(2 * PIXEL, **SKY)
    _, shown = pictures(scenes, context, "reproject")
    before, now = film_of(scenes[0], context), film_of(scenes[1], context, seed=1)
    left = 1 - 1 / END
    mean = (left * before[:, 2:] + now[:, :-2]) / (left + 1)
    np.testing.assert_allclose(shown[:, :-2], mean, rtol=1e-5)
    assert same_bits(shown[:, -2:], now[:, -2:])


@pytest.mark.parametrize("pipeline", ["compute", "fragment"])
def test_reset_shows_the_film(context: Context, pipeline: Pipeline) -> None:
    scenes = orbit(load("cornell"), 4, 2.0).scenes
    found = pictures(scenes, context, "reset", pipeline)
    for number, scene in enumerate(scenes):
        assert same_bits(found[number], film_of(scene, context, seed=number))


@pytest.mark.parametrize("mode", ["reproject", "taa", "wrls"])  # others are refused there
def test_both_pipelines_show_the_same_bits(context: Context, mode: Mode) -> None:
    scenes = orbit(load("cornell"), 4, 2.0).scenes
    one, other = (pictures(scenes, context, mode, p) for p in ("compute", "fragment"))
    assert all(map(same_bits, one, other))


@pytest.mark.parametrize("mode", HISTORIES)
def test_a_film_holds_no_history_and_a_still_camera_ends_with_it(
    context: Context, mode: Mode
) -> None:
    """The film has the bits of a render without history; in the end the screen has them, too."""
    scenes = orbit(load("cornell"), 6, 2.0).scenes
    renderer = Renderer(scenes[0], settings(scenes[0]), context)
    temporal = Temporal(context.gl, Way(mode))
    for number, scene in enumerate(scenes[1:], 1):
        renderer.render(2)
        temporal.leave(renderer)
        renderer.update(scene, seed=number)
        temporal.arrive(renderer)
    temporal.end = 8.0
    for samples, is_alone in ((1, False), (7, False), (8, True), (9, True)):
        renderer.render(samples)
        film = film_of(scenes[-1], context, samples, seed=5)
        assert same_bits(renderer.image().radiance, film)
        assert same_bits(screen_of(renderer, temporal), film) == is_alone
    assert END > 8
    temporal.release()
    renderer.release()


# --- what is no history ------------------------------------------------------------------------


@pytest.mark.parametrize("mode", ["reproject", "taa"])  # of wrls: tests/rendering/history
def test_history_that_is_seen_to_be_wrong_is_not_believed(context: Context, mode: Mode) -> None:
    """The case has no noise: a wall under an even sky that becomes three times as bright."""
    dim, bright = wall(), wall(background={"color": [3.0, 3.0, 3.0]})
    assert np.ptp(film_of(dim, context)) < 1e-6  # it is as bright everywhere
    *_, before, shown = pictures((*[dim] * 8, bright), context, mode)
    np.testing.assert_allclose(before, 0.5, rtol=1e-6)
    np.testing.assert_allclose(shown, 1.5, rtol=1e-5)


def test_under_another_light_history_counts_for_little(context: Context) -> None:
    """It keeps as many of its samples as OTHER_LIGHT says: its error is unknown."""
    scene = wall(**SKY)
    renderer = Renderer(scene, settings(scene), context)
    temporal = Temporal(context.gl)
    renderer.step(16)
    temporal.leave(renderer)
    renderer.update(bounces=2)
    temporal.arrive(renderer)
    resolver = temporal._resolver
    assert isinstance(resolver, Reproject)
    assert resolver._brought
    (brought,) = textures_of(context, resolver._brought)
    assert (brought[..., 3] == OTHER_LIGHT.most).all()
    temporal.release()
    renderer.release()


def test_the_evidence_is_the_bias_beyond_chance(context: Context) -> None:
    """Each tile of 8 x 8 pixels has its own, relative to the variance of one sample.

    A tile with few pixels has no evidence.
    """
    size, rng = (24, 8), np.random.default_rng(5)
    light, mean, history = noise(size, 1), noise(size, 2), noise(size, 3)
    light[:, :8, :3] += 1.0  # a bias
    history[:, 16:, 3] = np.where(rng.random((8, 8)) < 0.1, 3.0, 0.0)
    arrays = {"light": light, "mean": mean, "brought": history}
    found = drawn("evidence.frag", arrays, {}, (3, 1), context)[0, :, 0]
    d = (light - history)[..., :3] @ (0.2126, 0.7152, 0.0722)
    rarity = (1 / mean[:, :8, 3] + 1 / history[:, :8, 3]).mean()
    tile = d[:, :8].astype(float)
    bias = tile.mean() ** 2 - 6 * tile.var() / 64
    np.testing.assert_allclose(found[0], bias / (tile.var() / rarity), rtol=1e-4)
    assert found[1] == found[2] == 0


@pytest.mark.parametrize("mode", [mode for mode in HISTORIES if mode != "upsample"])
def test_a_view_of_other_objects_begins_again(context: Context, mode: Mode) -> None:
    balls = [sphere([0, 0, z], 1.0, "matte") for z in (-3, -6)]
    camera = {"position": [0, 0, 0], "look_at": [0, 0, -1]}
    one, two = (scene_of(balls[:n], {"matte": MATTE}, camera, **SKY) for n in (1, 2))
    _, shown = pictures((one, two), context, mode)
    assert same_bits(shown, film_of(two, context, seed=1))


def test_what_is_forgotten_is_not_shown(context: Context) -> None:
    scene = wall(**SKY)
    renderer = Renderer(scene, settings(scene), context)
    temporal = Temporal(context.gl)
    for seed in (1, 2):
        renderer.step(1)
        temporal.leave(renderer)
        renderer.update(seed=seed)
        temporal.arrive(renderer)
    renderer.step(1)
    assert temporal.show(renderer)
    temporal.forget()
    assert temporal.show(renderer) is None
    temporal.leave(renderer)  # and the next view begins from the film alone
    resolver = temporal._resolver
    assert isinstance(resolver, Reproject)
    assert resolver._history
    (history,) = textures_of(context, resolver._history)
    assert same_bits(history[..., :3], renderer.image().radiance)
    temporal.release()
    renderer.release()


def test_a_camera_alone_changes_no_light(context: Context) -> None:
    scene = load("cornell")
    renderer = Renderer(scene, settings(scene), context)
    temporal = Temporal(context.gl)
    renderer.step(1)
    temporal.leave(renderer)
    assert is_lit_alike(renderer, temporal.surfaces)
    renderer.update(orbit(scene, 4, 2.0).scenes[1])
    assert is_lit_alike(renderer, temporal.surfaces)
    renderer.update(bounces=1)
    assert not is_lit_alike(renderer, temporal.surfaces)
    renderer.update(scene.model_copy(update={"objects": scene.objects[1:]}), bounces=10)
    assert not is_lit_alike(renderer, temporal.surfaces)
    temporal.release()
    renderer.release()


def test_a_view_without_a_sample_keeps_the_history_before_it(context: Context) -> None:
    """Edits may follow each other faster than samples."""
    scenes = [wall(n * PIXEL, **SKY) for n in range(3)]
    renderer = Renderer(scenes[0], settings(scenes[0]), context)
    temporal = Temporal(context.gl)
    renderer.step(1)
    for scene in scenes[1:]:
        temporal.leave(renderer)
        renderer.update(scene, seed=1)
        temporal.arrive(renderer)
    resolver = temporal._resolver
    assert isinstance(resolver, Reproject)
    assert resolver._brought
    (brought,) = textures_of(context, resolver._brought)
    assert np.array_equal(brought[:, :-2, :3], film_of(scenes[0], context)[:, 2:])
    temporal.release()
    renderer.release()
