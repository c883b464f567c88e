"""Probes as balls: where they stand in the picture, what hides them, and what they show."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.gpu.context import Context
from glrt.rendering.screen.false_colors import VIRIDIS, FalseColors, Scale
from glrt.rendering.screen.probe_balls import RADIUS, ProbeBalls, farthest
from glrt.scene.scene import Scene
from tests.rendering.test_live_probes import warmed_up
from tests.support.builders import lamp, plane, quad, scene_of, sphere
from tests.support.renders import rendering

Floats = NDArray[Any]

SIDE = 96  # pixels
WAY: dict[str, Any] = {"method": "ddgi", "sampler": "sobol", "aov": ("depth",), "bounces": 3}
FAR = 1 / 1.18  # how far from the middle of the picture the far probes are
EYE = [0.5, 0.5, 0.68]  # straight before the probes at (0.5, 0.5, 0.5) and (0.5, 0.5, -0.5)
GRID = {"min": [-1, -1, -1], "max": [1, 1, 1], "counts": [2, 2, 2]}


def room(*things: dict[str, Any]) -> Scene:
    """It shines with 1 everywhere and has an albedo of a half; a frame is twice as high as far."""
    camera = {"position": EYE, "look_at": [0.5, 0.5, -1], "fov": 90}
    return scene_of(
        [sphere([0, 0, 0], 1, "glow"), *things], {"glow": lamp(1, 0.5)}, camera, **TABLES
    )


TABLES: dict[str, Any] = {"probes": GRID}


@contextmanager
def drawn(scene: Scene, context: Context, **settings: Any) -> Iterator[tuple[Floats, Any]]:
    """Radiance and distance of each pixel, (SIDE, SIDE, 4), row 0 on top; and whose."""
    way = {**WAY, "width": SIDE, "height": SIDE, **settings}
    with rendering(scene, context, **way) as renderer:
        renderer.render(1)
        with context.gl:
            balls, depth = ProbeBalls(context.gl), renderer.aov_mean("depth")
            tracer, light = renderer.probes.tracer, renderer.weighed(renderer.plan.weights)
            assert tracer
            assert depth
            found = balls.draw(light, depth.texture, tracer, scene.camera)
            yield np.frombuffer(found.read(), np.float32).reshape(SIDE, SIDE, 4), (renderer, found)
            balls.release()


def at(picture: Floats, x: float, y: float) -> Floats:
    """The pixel in a direction: of (0, 0) straight on, of (1, 1) upper right."""
    column, row = (round(SIDE / 2 * (1 + share)) for share in (x, -y))
    return np.asarray(picture[row, column])


def test_a_ball_shows_what_its_probe_holds(context: Context) -> None:
    """The room shines with 2; what comes over one surface and more of it is 1."""
    with drawn(room(), context, roulette=False) as (picture, _):
        assert at(picture, 0, 0)[:3] == pytest.approx(warmed_up(0.5), rel=1e-3)
        beside = picture[picture[..., 3] < 0]
        np.testing.assert_allclose(beside[:, :3], 1 + 0.5 * (1 + warmed_up(0.5)), rtol=1e-3)


def test_a_ball_is_as_large_as_it_looks(context: Context) -> None:
    """A disk of tan(asin(r / d)) about the middle of the picture."""
    with drawn(room(), context) as (picture, _):
        y, x = (np.mgrid[:SIDE, :SIDE] + 0.5) / SIDE * 2 - 1
        inner = np.hypot(x, y) < 0.75  # no other ball is there
        expected = RADIUS / np.sqrt(0.18**2 - RADIUS**2)  # cells are of length 1
        covered = 4 * np.count_nonzero((picture[..., 3] >= 0) & inner) / SIDE**2
        assert covered == pytest.approx(np.pi * expected**2, rel=0.02)


def test_balls_stand_on_their_side(context: Context) -> None:
    """Far probes at (-0.5, 0.5, -0.5), to the left, and at (0.5, -0.5, -0.5), below."""
    with drawn(room(), context) as (picture, _):
        assert at(picture, -FAR, 0)[3] > 0
        assert at(picture, 0, -FAR)[3] > 0
        assert at(picture, FAR, 0)[3] < 0
        assert at(picture, 0, FAR)[3] < 0


def test_what_is_nearer_hides_balls(context: Context) -> None:
    screen = quad([-2, -2, 0.63], [4, 0, 0], [0, 4, 0], "glow")
    with drawn(room(screen), context) as (picture, _):
        assert picture[..., 3].max() < 0
    screen = quad([-2, -2, 0], [4, 0, 0], [0, 4, 0], "glow")  # between near and far ones
    with drawn(room(screen), context) as (picture, _):
        assert at(picture, 0, 0)[3] > 0
        assert at(picture, -FAR, 0)[3] < 0


def test_a_probe_in_a_solid_has_no_ball(context: Context) -> None:
    """It cannot be pushed out of its cell; a screen of two sides shows whether it is drawn."""
    with drawn(room(sphere([-0.5, 0.5, -0.5], 0.49, "glow")), context) as (picture, (renderer, _)):
        assert at(picture, -FAR, 0)[3] < 0
        places = renderer.probes.tracer.maps["probe_places"]
        used = np.frombuffer(places.read(), np.float32).reshape(-1, 4)[:8, 3]
        assert used.tolist() == [1, 1, 0, 1, 1, 1, 1, 1]


def test_distances_are_those_to_what_is_around(context: Context) -> None:
    """The near ball hides the one behind it, whose distance would be longer by 1.

    From (0.5, 0.5, 0.5) towards the eye to the sphere: sqrt(1 - 0.5) - 0.5, about as cos^50.
    """
    with drawn(room(), context) as (picture, _):
        assert at(picture, 0, 0)[3] == pytest.approx(0.207, rel=0.05)


def test_nothing_is_farther_than_the_scale_tells(context: Context) -> None:
    """Above an open floor: its end, and the last colour of the view."""
    floor = scene_of(
        [plane([0, -1, 0], [0, 1, 0], "glow")],
        {"glow": lamp(1, 0.5)},
        {"position": [0.5, 0.9, 0.9], "look_at": [0.5, 0.5, 0.5], "fov": 40},
        **TABLES,
    )
    with drawn(floor, context) as (picture, (renderer, balls)):
        most = farthest(renderer.probes.tracer.grid)
        assert picture[..., 3].max() == pytest.approx(most, rel=1e-5)
        target = context.gl.simple_framebuffer((SIDE, SIDE), 3)
        colors, light = FalseColors(context.gl), renderer.weighed(renderer.plan.weights)
        with context.gl.scope(target, moderngl.NOTHING):
            colors.draw_distances(renderer.film, light, balls, Scale(VIRIDIS, 0.0, most, False))
        shown = np.frombuffer(target.read(), np.uint8).reshape(SIDE, SIDE, 3)[::-1]
        place = np.unravel_index(np.argmax(picture[..., 3]), (SIDE, SIDE))
        np.testing.assert_allclose(shown[place] / 255, VIRIDIS[-1], atol=0.01)
        beside = shown[picture[..., 3] < 0]
        assert beside.max() <= 0.26 * 255
        colors.release()
        target.release()
