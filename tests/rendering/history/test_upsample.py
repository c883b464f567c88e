"""Temporal upsampling: exact without noise, even where there is noise, and without ghosts."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest

from glrt.analysis.motion.playing import Played, play, read_texture, screen_of
from glrt.analysis.motion.sequences import Sequence
from glrt.core.errors import RenderError
from glrt.gpu.context import Context
from glrt.rendering.history.lattice import corner_of
from glrt.rendering.history.temporal import Temporal, Way
from glrt.rendering.history.upsample import PAIR
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.rendering.history.fed_upsampling import Pictures, fed, flat
from tests.rendering.history.twins import Array
from tests.rendering.history.upsample_twin import reconstructed
from tests.support.builders import MATTE, lamp, plane, quad, scene_of
from tests.support.images import same_bits
from tests.support.moving import FOV, two_walls, view, wall

SIZE = (16, 12)
PIXEL = 1.0 / SIZE[1]
SKY: dict[str, Any] = {"background": {"bottom": [0.1, 0.2, 0.3], "top": [3.0, 2.0, 1.0]}}


def without_noise(picture: Array) -> Pictures:
    return lambda: np.stack([picture, picture])


ONE = np.zeros(SIZE[::-1])


# --- pictures of given samples --------------------------------------------------------------------


@pytest.mark.parametrize("factor", [2, 4])
def test_without_noise_any_picture_is_exact_once_each_pixel_was_sampled(
    context: Context, factor: int
) -> None:
    """Also a picture of random pixels: the mean around then counts for nothing."""
    picture = np.random.default_rng(2).uniform(0, 5, (*SIZE[::-1], 3)).astype(np.float32)
    with flat(context, ONE) as now, fed(context, without_noise(picture), factor) as made:
        for number in range(factor**2):
            own, _, shown = made.frame(now)
            is_sampled = own[..., 3] > 0
            assert is_sampled.mean() == pytest.approx((number + 1) / factor**2)
            assert same_bits(shown[is_sampled][:, :3], picture[is_sampled])
        assert is_sampled.all()
        assert made.step == 1


def test_a_constant_picture_stays_constant(context: Context) -> None:
    picture = np.full((*SIZE[::-1], 3), [3.0, 1.0, 0.1])
    with flat(context, ONE) as now, fed(context, without_noise(picture), 4) as made:
        for _ in range(20):
            np.testing.assert_allclose(made.frame(now)[2][..., :3], picture, rtol=2e-6)


def test_a_frame_is_what_the_twin_makes_of_it(context: Context) -> None:
    """Noisy samples of two objects; the first lattice begins at a pixel other than (0, 0)."""
    rng = np.random.default_rng(3)
    objects = ONE.copy()
    objects[:, 7:] = 1
    pairs = rng.exponential(1.0, (2, *SIZE[::-1], 3)).astype(np.float32)
    with flat(context, objects) as now, fed(context, lambda: pairs, 4) as made:
        made._cycle = made._cycle._replace(shift=6)
        own, guess, shown = made.frame(now)
        assert made.corners == [corner_of(6, 4)]
    twin = reconstructed(pairs.astype(float), objects, made.corners[0], 4)
    assert (own[..., 3] > 0).sum() == 12
    np.testing.assert_allclose(guess[..., :3], twin.guess, rtol=1e-4)
    np.testing.assert_allclose(guess[..., 3], twin.guessed, rtol=1e-4)
    np.testing.assert_allclose(shown[..., :3], twin.shown, rtol=1e-4)
    np.testing.assert_allclose(shown[..., 3], twin.stands_for, rtol=1e-4)


def test_light_of_another_object_is_left_out(context: Context) -> None:
    """An object of a pixel's width without a sample shows its neighbour, until it has one."""
    objects = ONE.copy()
    objects[:, 6:] = 1
    objects[:, 3] = 2
    picture = np.repeat(1.0 + objects[..., None] ** 2, 3, axis=2)
    with flat(context, objects) as now, fed(context, without_noise(picture), 4) as made:
        first = made.frame(now)[2][..., :3]
        has_none = objects == 2
        np.testing.assert_allclose(first[~has_none], picture[~has_none], rtol=2e-6)
        np.testing.assert_allclose(first[has_none], 1.0, rtol=2e-6)
        for _ in range(15):
            last = made.frame(now)[2][..., :3]
    np.testing.assert_allclose(last, picture, rtol=2e-6)


def test_even_noise_is_averaged_over_pixels_and_frames(context: Context) -> None:
    """The mean square error is that of five samples, where a pixel had one on average."""
    rng = np.random.default_rng(4)
    with (
        flat(context, ONE) as now,
        fed(context, lambda: rng.normal(1.0, 0.2, (2, *SIZE[::-1], 3)), 4) as made,
    ):
        for _ in range(8):
            shown = made.frame(now)[2]
    assert np.square(shown[..., :3] - 1).mean() < 0.2**2 / 5


def test_samples_that_are_dark_by_chance_do_not_show_as_black_pixels(context: Context) -> None:
    """Pairs of zeros have no noise of their own; that of pixels farther away counts then."""
    size = 40, 40
    rng = np.random.default_rng(5)
    bright = rng.exponential(1.0, (2, size[1], size[0], 3))
    dark = bright.copy()
    dark[:, 14:27, 14:27] = 0.0  # 3 x 3 sampled pixels at a distance of 4
    given = iter([bright, dark])
    with flat(context, np.zeros(size[::-1])) as now, fed(context, lambda: next(given), 4) as made:
        made.frame(now)
        own, guess, shown = made.frame(now)
    (x, y), middle = made.corners[1], 20
    at = y + 4 * round((middle - y) / 4), x + 4 * round((middle - x) / 4)
    assert not own[at][:3].any()
    assert own[at][3] == PAIR
    assert shown[at][:3].mean() > 0.5 * guess[at][:3].mean() > 0.1


def test_light_that_changed_is_followed_at_once(context: Context) -> None:
    """History of other light is kept within the range of the samples around."""
    light = [5.0]
    with (
        view(wall(), context, SIZE) as one,
        view(wall(), context, SIZE) as two,
        fed(context, lambda: np.full((2, *SIZE[::-1], 3), light[0]), 2) as made,
    ):
        made.frame(one)
        light[0] = 1.0
        with context.gl:
            made.arrive(two, one, False)
        own, _, shown = made.frame(two)
    np.testing.assert_allclose(shown[..., :3], 1.0, rtol=1e-5)
    assert (own[..., 3] > 0).mean() == pytest.approx(1 / 4), "own samples under other light end"


def test_a_camera_that_moves_over_linear_shading_shows_it(context: Context) -> None:
    """By 0.3 pixels a view, at most a quarter of a pixel is the picture off its place."""
    slope, step = 0.5, 0.3 * PIXEL
    middles = np.arange(SIZE[0]) - (SIZE[0] - 1) / 2
    shown: list[Array] = []

    def truth() -> Array:
        line = 9 + slope * (middles + 0.3 * len(shown))
        return np.broadcast_to(line[None, :, None], (*SIZE[::-1], 3)).astype(np.float32)

    with fed(context, lambda: np.stack([truth()] * 2), 2) as made:
        for number in range(12):
            before, now = wall(max(number - 1, 0) * step), wall(number * step)
            with view(before, context, SIZE) as old, view(now, context, SIZE) as new:
                if number:
                    with context.gl:
                        made.arrive(new, old, True)
                picture, wanted = made.frame(new)[2], truth()
            shown.append(picture)
    off = np.abs(picture[..., :3] - wanted)[2:-2, 2:-4] / slope
    assert off.max() < 0.25, off.max()


# --- pictures of paths ----------------------------------------------------------------------------


@contextmanager
def upsampled(scene: Scene, context: Context, factor: int) -> Iterator[tuple[Renderer, Temporal]]:
    settings = settings_for(scene.render, width=SIZE[0], height=SIZE[1], sampler="independent")
    renderer, temporal = (
        Renderer(scene, settings, context),
        Temporal(context.gl, Way("upsample", factor=factor)),
    )
    yield renderer, temporal
    temporal.release()
    renderer.release()


def textures_of(temporal: Temporal, context: Context) -> list[Array]:
    assert temporal.upsampled
    with context.gl:
        return [read_texture(one).copy() for one in temporal.upsampled._made[0].textures]


def test_the_samples_are_those_of_the_film(context: Context) -> None:
    """Two cycles over all pixels have the first four samples; the film has its bits of reset."""
    with upsampled(wall(**SKY), context, 2) as (renderer, temporal):
        assert temporal.can_upsample(renderer)
        for samples in (PAIR, 2 * PAIR):
            for _ in range(4):
                temporal.upsample(renderer)
            own = textures_of(temporal, context)[0]
            assert (own[..., 3] == samples).all()
            alone = Renderer(renderer.scene, renderer.settings, context)
            np.testing.assert_allclose(
                own[..., :3], alone.render(samples).image().radiance, rtol=1e-5
            )
            alone.release()
        assert renderer.samples == 0
        film = renderer.render(1).image().radiance
        alone = Renderer(renderer.scene, renderer.settings, context)
        assert same_bits(film, alone.render(1).image().radiance)
        alone.release()
        assert not same_bits(screen_of(renderer, temporal), film), "what was shown goes on"


def test_what_was_hidden_has_no_history(context: Context) -> None:
    """A quad goes left by 4 pixels, the wall behind it by 2: no light of the quad stays there."""
    scenes = [two_walls(0.0, **SKY), two_walls(2 * PIXEL, **SKY)]
    with upsampled(scenes[0], context, 2) as (renderer, temporal):
        for _ in range(4):
            temporal.upsample(renderer)
        temporal.leave(renderer)
        renderer.update(scenes[1], seed=1)
        temporal.arrive(renderer)
        resolver = temporal.upsampled
        assert resolver
        known = [one for one in resolver._known if one]
        with context.gl:
            own, guess = (read_texture(one)[..., 3].copy() for one in known)
        edge = SIZE[0] // 2 - 4
        for samples in (own, guess):
            assert (samples[:, edge : edge + 2] == 0).all()
            assert (samples[:, 1 : edge - 1] > 0).all()
            assert (samples[:, edge + 3 : -3] > 0).all()
        temporal.upsample(renderer)
        own = textures_of(temporal, context)[0]
        assert {*own[:, edge : edge + 2, 3].ravel()} == {0.0, float(PAIR)}


def test_a_view_of_other_objects_begins_again(context: Context) -> None:
    with upsampled(wall(**SKY), context, 2) as (renderer, temporal):
        temporal.upsample(renderer)
        temporal.leave(renderer)
        renderer.update(two_walls(0.0, **SKY), seed=1)
        temporal.arrive(renderer)
        assert temporal.upsampled
        assert temporal.upsampled._known == [None, None]
        temporal.upsample(renderer)
        assert (textures_of(temporal, context)[0][..., 3] > 0).mean() == 1 / 4


@pytest.mark.slow
def test_particles_are_part_of_a_film_at_full_size(context: Context) -> None:
    """A picture with particles is no sum of paths, so the mode shows the film and its history."""
    materials = {"matte": MATTE, "lamp": lamp(4.0)}
    objects = [quad([-1, 2, 0], [2, 0, 0], [0, 0, 2], "lamp"), plane([0, 0, 0], [0, 0, 1], "matte")]
    cameras = ({"position": [x, 0, 1], "look_at": [x, 0, 0], "fov": FOV} for x in (0, PIXEL))
    scenes = tuple(scene_of(objects, materials, camera) for camera in cameras)
    options: Any = {"width": SIZE[0], "height": SIZE[1], "caustics": "on", "bounces": 3}
    played = Played(settings_for(scenes[0].render, **options), Way("upsample"))
    usual = played._replace(way=Way("reproject"))
    one, other = ([*play(Sequence("test", scenes), way, context)] for way in (played, usual))
    assert all(map(same_bits, one, other))


@pytest.mark.slow
def test_the_fragment_pipeline_is_refused_by_name(context: Context) -> None:
    scenes = (wall(**SKY), wall(PIXEL, **SKY))
    settings = settings_for(scenes[0].render, width=SIZE[0], height=SIZE[1])
    with pytest.raises(RenderError, match=r"temporal upsample .* compute shaders"):
        [
            *play(
                Sequence("test", scenes),
                Played(settings, Way("upsample"), None, "fragment"),
                context,
            )
        ]
