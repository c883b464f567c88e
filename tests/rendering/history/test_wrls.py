"""The passes of weighted recursive least squares: against a twin, and models that follow a wall."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from itertools import pairwise
from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.analysis.motion.playing import Played, play, read_texture
from glrt.analysis.motion.sequences import Sequence, orbit
from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.history.history_filter import Fresh
from glrt.rendering.history.temporal import Mode, Temporal, Way
from glrt.rendering.history.wrls import Predictor, Wrls
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.rendering.history.twins import Array, FactoredWrls
from tests.rendering.history.wrls_twin import StillWrls, reconstructed
from tests.support.moving import drawn, noise, textures_of, two_walls, view, wall

SIZE = (16, 12)
PIXEL = 1.0 / SIZE[1]
END = 64.0
PREDICTORS: tuple[Predictor, ...] = ("published", "delayed")


def films(count: int, samples: float, seed: int = 0) -> list[Array]:
    """Gamma noise on a wall, (H, W, 4) each; a: samples."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        film = np.empty((SIZE[1], SIZE[0], 4), np.float32)
        film[..., :3] = rng.gamma(9, 1 / 9, (*film.shape[:2], 1)) * (0.5, 0.4, 0.3)
        film[..., 3] = samples
        found.append(film)
    return found


@contextmanager
def textured(context: Context, film: Array) -> Iterator[moderngl.Texture]:
    texture = context.gl.texture(film.shape[1::-1], 4, film.tobytes(), dtype="f4")
    yield texture
    texture.release()


def shown_of(wrls: Wrls, now: Any, before: Any, film: Array, context: Context) -> Array:
    """The picture shown of a film in a view after another one; history ends at END samples."""
    with context.gl, textured(context, film) as light:
        wrls.arrive(now, before, True)
        texture = wrls.show(now, Fresh(light, light, int(film[0, 0, 3]), END))
        return np.array(read_texture(texture))


def models(wrls: Wrls, context: Context, is_brought: bool = False) -> Array:
    """The rows of all models, (7, H, W, 4)."""
    canvas = wrls._brought if is_brought else wrls._made
    return np.stack(textures_of(context, *canvas.textures[1:]))


# --- a still picture ------------------------------------------------------------------------------


@pytest.mark.parametrize("samples", [(1, 1, 1, 1, 1, 1), (2, 6, 6, 1, 4, 4)])
@pytest.mark.parametrize("predictor", PREDICTORS)
def test_the_passes_do_what_the_twin_does(
    context: Context, predictor: Predictor, samples: tuple[int, ...]
) -> None:
    """A view is a frame; one of more samples than that before it is several."""
    wrls, twin = Wrls(context.gl, predictor), StillWrls(predictor == "delayed")
    with view(wall(), context, SIZE) as here:
        for number, count in enumerate(samples):
            (film,) = films(1, count, number)
            shown = shown_of(wrls, here, here if number else None, film, context)
            truth = twin.show(film, END)
            np.testing.assert_allclose(shown[..., :3], truth, rtol=5e-3, atol=1e-3)
            assert (shown[..., 3] == number + 1).all()
    wrls.release()


@pytest.mark.parametrize("samples", [1.0, 8.0])
def test_the_film_is_reconstructed_within_objects_alone(context: Context, samples: float) -> None:
    """Pixels without a sample count for nothing; of more samples neighbours count for less."""
    film, position = noise(SIZE, 1), np.zeros((SIZE[1], SIZE[0], 4), np.float32)
    film[2:4, 5, 3], film[2:4, 5, :3] = 0, 99
    position[:, 7:, 3], position[6:, :, 3] = 1, 2
    arrays = {"light": film, "mean": film, "position": position}
    found = drawn("reconstruct.frag", arrays, {"samples": samples}, SIZE, context)
    truth = reconstructed(film[..., :3], film[..., 3], position[..., 3], samples)
    np.testing.assert_allclose(found[..., :3], truth, rtol=1e-5)
    assert np.array_equal(found[..., 3], film[..., 3])


def test_a_pixel_without_a_sample_shows_what_its_model_predicts(context: Context) -> None:
    """Its model stays. A pixel without a model still has none."""
    wrls, frames = Wrls(context.gl), films(3, 1.0)
    frames[2][4, 4] = 0
    with view(wall(), context, SIZE) as here:
        for number, film in enumerate(frames):
            shown_of(wrls, here, here if number else None, film, context)
        before, after = models(wrls, context, is_brought=True), models(wrls, context)
        assert np.array_equal(before[:, 4, 4], after[:, 4, 4])
        assert not np.array_equal(before[:, 4, 5], after[:, 4, 5])
        shown_of(wrls, here, None, frames[2], context)
        assert (models(wrls, context)[0, ..., 3] == (frames[2][..., 3] > 0)).all()
    wrls.release()


def test_the_film_takes_the_place_of_predictions(context: Context) -> None:
    """Evenly: at a quarter of the end it has a quarter, at the end all, to the last bit."""
    wrls, frames = Wrls(context.gl), films(6, 1.0)
    last = frames[-1]
    with view(wall(), context, SIZE) as here:
        for number, film in enumerate(frames[:-1]):
            shown_of(wrls, here, here if number else None, film, context)
        wrls.arrive(here, here, True)
        with context.gl, textured(context, last) as light:
            shown = []
            for samples, end in ((16, 1e9), (16, 64.0), (64, 64.0)):
                fresh = Fresh(light, light, samples, end)
                shown.append(np.array(read_texture(wrls.show(here, fresh))[..., :3]))
    film = last[..., :3]
    np.testing.assert_allclose(shown[1], film + 0.75 * (shown[0] - film), rtol=1e-5)
    assert np.array_equal(shown[2], film)
    wrls.release()


def test_numbers_of_the_history_are_reported(context: Context) -> None:
    """Views that a model has seen, and the weight of the film, as the twin has it."""
    twin = FactoredWrls(np.full((1, 3), 0.5), frames=1)
    scene = wall()
    settings = settings_for(scene.render, width=SIZE[0], height=SIZE[1], sampler="independent")
    renderer, temporal = Renderer(scene, settings, context), Temporal(context.gl, Way("wrls"))
    for number in range(3):
        temporal.leave(renderer)
        renderer.update(scene, seed=number)
        temporal.arrive(renderer)
        renderer.step(1)
    twin.add(np.full((1, 3), 0.5))
    history, weight = temporal.told(renderer, "history"), temporal.told(renderer, "weight")
    assert history
    assert weight
    seen, weights = textures_of(context, history.texture, weight.texture)
    assert (seen[..., 3] == 3).all()
    assert history.least == 1
    np.testing.assert_allclose(weights[..., 3], twin.weight[0], rtol=1e-5)
    temporal.forget()
    assert temporal.told(renderer, "history") is None
    temporal.release()
    renderer.release()


@pytest.mark.parametrize("mode", ["reproject", "taa"])
def test_other_ways_report_the_samples_of_their_history(context: Context, mode: Mode) -> None:
    """A wall moves by two pixels: two samples, and one where nothing was seen before."""
    scenes = wall(), wall(2 * PIXEL)
    settings = settings_for(scenes[0].render, width=SIZE[0], height=SIZE[1], sampler="independent")
    renderer, temporal = Renderer(scenes[0], settings, context), Temporal(context.gl, Way(mode))
    renderer.step(1)
    temporal.leave(renderer)
    renderer.update(scenes[1], seed=1)
    temporal.arrive(renderer)
    renderer.step(1)
    told = temporal.told(renderer, "history")
    assert told
    (numbers,) = textures_of(context, told.texture)
    assert numbers[:, :-2, 3] == pytest.approx(2, abs=0.02)
    assert (numbers[:, -2:, 3] <= told.least).all()
    assert temporal.told(renderer, "weight") is None
    temporal.release()
    renderer.release()


# --- motion ---------------------------------------------------------------------------------------


def moved(scenes: list[Scene], context: Context) -> tuple[Array, Array]:
    """Models of the first view, and as they are brought to the last one, by way of all others."""
    wrls = Wrls(context.gl)
    with ExitStack() as stack:
        views = [stack.enter_context(view(scene, context, SIZE)) for scene in scenes]
        for number, film in enumerate(films(3, 1.0)):
            shown_of(wrls, views[0], views[0] if number else None, film, context)
        made = models(wrls, context)
        with context.gl:
            for before, now in pairwise(views):
                wrls.arrive(now, before, True)
        brought = models(wrls, context, is_brought=True)
    wrls.release()
    return made, brought


def test_a_pan_by_whole_pixels_moves_the_models(context: Context) -> None:
    made, brought = moved([wall(), wall(2 * PIXEL)], context)
    assert np.array_equal(brought[:, :, :-2], made[:, :, 2:])
    assert not brought[:, :, -2:].any()


def test_a_view_without_a_sample_hands_its_models_on(context: Context) -> None:
    made, brought = moved([wall(), wall(PIXEL), wall(3 * PIXEL)], context)
    assert np.array_equal(brought[:, :, :-3], made[:, :, 3:])
    assert not brought[:, :, -3:].any()


def test_between_pixels_the_nearest_model_is_taken_as_it_is(context: Context) -> None:
    """A move by 0.3 pixels takes the same pixel's model, one by 0.7 pixels its neighbour's."""
    made, brought = moved([wall(), wall(0.3 * PIXEL)], context)
    assert np.array_equal(brought[:, :, :-1], made[:, :, :-1])
    made, brought = moved([wall(), wall(0.7 * PIXEL)], context)
    assert np.array_equal(brought[:, :, :-1], made[:, :, 1:])


def test_what_was_hidden_has_no_model_in_a_band_as_wide_as_the_parallax(context: Context) -> None:
    """A quad goes left by 4 pixels, the wall behind it by 2; edges give theirs to edges alone."""
    _, brought = moved([two_walls(0.0), two_walls(2 * PIXEL)], context)
    is_known: Array = np.all(brought[0, ..., 3] > 0, axis=0)
    edge = SIZE[0] // 2 - 4
    assert not is_known[edge : edge + 2].any()
    assert is_known[: edge - 1].all()
    assert is_known[edge + 4 : -3].all()
    assert not is_known[-2:].any()


@pytest.mark.parametrize("predictor", PREDICTORS)
def test_a_wall_that_becomes_brighter_is_followed(context: Context, predictor: Predictor) -> None:
    """Without noise, to three times the light: by the published predictor at once, since its slope
    is free; the delayed one shows what of the old light is in its fit, for some views."""
    bright = wall(background={"color": [3.0, 3.0, 3.0]})
    scenes = (*[wall()] * 8, *[bright.model_copy(update={"title": str(n)}) for n in range(8)])
    size = {"width": SIZE[0], "height": SIZE[1], "sampler": "independent"}
    settings = settings_for(scenes[0].render, **size)
    shown = [*play(Sequence("step", scenes), Played(settings, Way("wrls", predictor)), context)]
    assert shown[7] == pytest.approx(0.5, rel=1e-3)
    first, last = shown[8] / 1.5, shown[15] / 1.5
    if predictor == "published":
        assert first == pytest.approx(1, rel=5e-3)
    else:
        assert 0.3 < first.mean() < 0.7
    assert last == pytest.approx(1, rel=5e-3)


@pytest.mark.parametrize("predictor", PREDICTORS)
def test_an_orbit_is_clearer(context: Context, predictor: Predictor) -> None:
    """24 x 24 pixels, two samples a frame: it has less than half the film's squared error."""
    scene = load("cornell")
    frames = orbit(scene, 24, 1.0)
    settings = settings_for(scene.render, width=24, height=24, sampler="independent")
    truth = [
        *play(Sequence("still", frames.scenes[23:]), Played(settings, Way("reset")), context, 512)
    ][-1]
    squared = []
    ways: list[tuple[Mode, Predictor]] = [("reset", "published"), ("wrls", predictor)]
    for mode, way in ways:
        *_, last = play(frames, Played(settings, Way(mode, way)), context, 2)
        dark = truth.max(axis=2) < 3
        squared.append(float(np.square(np.minimum(last, 1) - np.minimum(truth, 1))[dark].mean()))
    assert squared[1] < 0.5 * squared[0]


@pytest.mark.parametrize("predictor", PREDICTORS)
def test_a_view_under_other_light_is_right_once_it_has_samples(
    context: Context, predictor: Predictor
) -> None:
    """The light has no noise, and dims to a quarter after sixteen samples.

    The picture is right within 2 % after four samples.
    """
    dim = wall(background={"color": [0.25, 0.25, 0.25]})
    scenes = (*[wall()] * 16, *[dim] * 4)
    size = {"width": SIZE[0], "height": SIZE[1], "sampler": "independent"}
    settings = settings_for(scenes[0].render, **size)
    *_, last = play(Sequence("step", scenes), Played(settings, Way("wrls", predictor)), context)
    assert last == pytest.approx(0.125, rel=0.02)
