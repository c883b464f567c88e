"""Motion blur: closed forms, means of stills, and whether the error estimate is right."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from tests.support.builders import lamp, plane, quad, scene_of, sphere
from tests.support.renders import Estimate, assert_mean, same

RED: dict[str, Any] = {"type": "lambertian", "color": [0.8, 0.3, 0.2]}
SKY: dict[str, Any] = {"bottom": [0.2, 0.2, 0.2], "top": [0.7, 0.8, 1.0]}
FRAME = 0.25  # seconds
WIDTH, HEIGHT = 32, 24


def moving(objects: list[dict[str, Any]], target: str, ends: list[Any], **tables: Any) -> Scene:
    """A frame in which a value goes from one end to the other while the shutter is open."""
    materials = {"red": RED, "lamp": lamp(1.0)}
    tracks = [{"target": target, "times": [0, FRAME], "values": ends}]
    camera = {"shutter": 1.0, "fov": 40, "position": [0, 0, 5], "look_at": [0, 0, 0]}
    animation = {"fps": 1 / FRAME, "tracks": tracks}
    return scene_of(objects, materials, camera, animation=animation, **tables).at_frame(0)


def ball_on_a_floor() -> Scene:
    objects = [plane([0, -0.5, 0], [0, 1, 0], "red"), {**sphere([0] * 3, 0.5, "red"), "name": "it"}]
    return moving(objects, "objects.it.center", [[-1, 0, 0], [1, 0.5, 0]], background=SKY)


def opened(scene: Scene, context: Context, **settings: Any) -> Renderer:
    usual = {"width": WIDTH, "height": HEIGHT, "bounces": 4, "samples": 64}
    return Renderer(scene, context=context, opens_shutter=True, **{**usual, **settings})


def pictures(scene: Scene, context: Context, count: int, **settings: Any) -> list[Image]:
    """Pictures with seeds of their own."""
    renderer, found = opened(scene, context, **settings), []
    for seed in range(count):
        renderer.update(seed=1000 + seed)
        found.append(renderer.render().image())
    renderer.release()
    return found


@pytest.mark.slow
def test_the_blur_of_a_ball_is_the_mean_of_stills(context: Context) -> None:
    """64 stills, in the middle of equal parts of the time, against 16 blurred pictures."""
    frame = ball_on_a_floor()
    blurred = pictures(frame, context, 16)
    stills = []
    renderer = opened(frame.in_shutter(0.0), context)
    for number in range(64):
        renderer.update(frame.in_shutter((number + 0.5) / 64), seed=number)
        stills.append(renderer.render().image())
    renderer.release()
    means = [np.mean([it.radiance for it in some], axis=0) for some in (blurred, stills)]
    errors = [
        np.sqrt(np.sum([np.square(it.stderr) for it in some], axis=0)) / len(some)
        for some in (blurred, stills)
    ]
    away = by_block(means[0] - means[1])
    error = np.sqrt(by_block(errors[0] ** 2 + errors[1] ** 2) / 64)
    assert np.abs(away / error).max() < 4.5
    assert (error < 0.01 * by_block(means[1])).all()
    assert np.abs(means[0] - stills[0].radiance).max() > 0.2


def by_block(values: NDArray[Any], size: int = 8) -> NDArray[np.float64]:
    """Means over blocks of pixels."""
    rows, columns = HEIGHT // size, WIDTH // size
    found: NDArray[np.float64] = (
        np.asarray(values, np.float64).reshape(rows, size, columns, size, 3).mean(axis=(1, 3))
    )
    return found


@pytest.mark.slow
@pytest.mark.parametrize("way", [1.2, 0.3])
def test_a_lamp_that_passes_makes_a_trapezoid(context: Context, way: float) -> None:
    """A square of width 0.8 before black: each place is as bright as long as it is covered."""
    wide = 0.8
    square = {**quad([0, -2, 0], [wide, 0, 0], [0, 4, 0], "lamp"), "name": "it"}
    low = -(wide + way) / 2
    ends = [[low, -2, 0], [low + way, -2, 0]]
    frame = moving([square], "objects.it.corner", ends)
    images = pictures(frame, context, 64, bounces=0)
    columns = np.array([it.radiance[..., 0].mean(axis=0, dtype=np.float64) for it in images])
    half = 5 * np.tan(np.radians(20)) * WIDTH / HEIGHT  # of the plane that the camera sees
    fine = 1000
    places = (np.arange(WIDTH * fine) + 0.5) / (WIDTH * fine) * 2 * half - half
    covered = np.minimum(places - low, way) - np.maximum(places - low - wide, 0)
    truth = (np.clip(covered, 0, None) / way).reshape(WIDTH, fine).mean(axis=1)
    error = columns.std(axis=0, ddof=1) / np.sqrt(len(images))
    assert (np.abs(columns.mean(axis=0) - truth) < 5.5 * error + 2e-4).all()
    assert error.max() < 2e-3
    assert_mean(
        Estimate(columns.mean(keepdims=True)[0], np.array([2e-4])), truth.mean(), within=0.02
    )


@pytest.mark.slow
def test_a_ball_that_grows_and_a_lamp_that_dims_are_blurred_too(context: Context) -> None:
    """A lamp whose light falls to nothing gives half of it."""
    objects = [{**sphere([0, 0, 0], 2, "lamp"), "name": "it"}]
    dimmed = moving(objects, "lights.lamp", [1.0, 0.0])
    image = pictures(dimmed, context, 1, bounces=0, width=4, height=4, samples=1024)[0]
    middle = image.radiance[1:3, 1:3].mean()
    assert middle == pytest.approx(0.5, abs=2e-3)
    grown = moving(objects, "objects.it.radius", [0.2, 1.0])
    stills = [pictures(grown.in_shutter(s), context, 1, bounces=0)[0] for s in (0.0, 1.0)]
    found = pictures(grown, context, 1, bounces=0)[0].radiance.mean()
    assert stills[0].radiance.mean() < found < stills[1].radiance.mean()


@pytest.mark.slow
def test_the_error_of_a_moving_ball_is_told_right(context: Context) -> None:
    """The true error of pixels over the estimate is 1 within 5 %, and that of 8 x 8 blocks 15 %."""
    images = pictures(ball_on_a_floor(), context, 200)
    radiance = np.array([it.radiance for it in images], np.float64)
    told = np.mean([np.square(it.stderr, dtype=np.float64) for it in images], axis=0)
    true = radiance.var(axis=0, ddof=1)
    assert np.sqrt(true.mean() / told.mean()) == pytest.approx(1, abs=0.05)
    blocks = np.array([by_block(it) for it in radiance]).var(axis=0, ddof=1)
    assert np.sqrt(blocks.mean() / (by_block(told) / 64).mean()) == pytest.approx(1, abs=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("way", [{"pipeline": "fragment"}, {"method": "hybrid", "effects": ()}])
def test_other_ways_to_render_see_the_same_times(context: Context, way: dict[str, Any]) -> None:
    frame = ball_on_a_floor()
    found, still = pictures(frame, context, 1, **way), opened(frame.still, context, **way)
    assert not same(found[0], still.render().image())
    still.release()
    if "pipeline" in way:
        assert same(found[0], pictures(frame, context, 1)[0])
