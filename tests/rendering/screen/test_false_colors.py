"""False colours on the driver against the same numbers and scales in numpy."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from glrt.core.errors import RenderError
from glrt.core.resources import folder
from glrt.error.estimate import squared_levels
from glrt.gpu import glsl
from glrt.gpu.context import Context
from glrt.image.image import Image
from glrt.plan.plan import ONE, Layering
from glrt.rendering.renderer import Renderer
from glrt.rendering.screen.false_colors import (
    BLUE_WHITE_RED,
    DIFFERENCE,
    DROPPED,
    ERROR,
    HISTORY,
    VIRIDIS,
    FalseColors,
    Scale,
    Told,
    symmetric,
)
from glrt.scene.scene import Scene, with_lights
from tests.support.builders import MATTE, lamp, quad, room_of_planes, scene_of, sphere

SIZE: dict[str, Any] = {"width": 24, "height": 20, "bounces": 3, "sampler": "independent"}
Codes = NDArray[np.uint8]
LUMINANCE = (0.2126, 0.7152, 0.0722)  # of linear sRGB, Rec. 709


def room(albedo: float = 0.5, **lights: float) -> Scene:
    """A room with two lamps, whose ball's colour may differ."""
    ball = {"type": "lambertian", "color": [albedo, 0.5, 0.5]}
    materials = {"white": MATTE, "ball": ball, "warm": lamp(5.0), "cold": lamp(2.0)}
    objects = [
        *room_of_planes("white"),
        sphere([0.3, -0.4, -0.6], 0.3, "ball"),
        quad([-0.9, 0.9, -0.9], [0.5, 0, 0], [0, 0, 0.5], "warm"),
        quad([0.4, 0.9, -0.9], [0.5, 0, 0], [0, 0, 0.5], "cold"),
    ]
    return scene_of(objects, materials, lights=lights)


@contextmanager
def traced(
    context: Context, scene: Scene, samples: int, layering: Layering = "groups"
) -> Iterator[Renderer]:
    renderer = Renderer(scene, context=context, layering=layering, **SIZE)
    try:
        yield renderer.render(samples)
    finally:
        renderer.release()


def drawn(renderer: Renderer, draw: Callable[[FalseColors, moderngl.Texture], None]) -> Codes:
    """The picture drawn from a film's light, (H, W, 3), row 0 on top."""
    gl = renderer.context.gl
    with gl:
        colors, target = FalseColors(gl), gl.simple_framebuffer(renderer.size, 3)
        light = renderer.weighed(renderer.plan.weights)
        with gl.scope(target):
            draw(colors, light)
        codes = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
        colors.release()
        target.release()
    return codes.reshape(SIZE["height"], SIZE["width"], 3)[::-1]


def assert_drawn(codes: Codes, scale: Scale, numbers: Any) -> None:
    """The codes agree within 1 of 255: the shader rounds in float32, the truth in float64."""
    assert np.abs(codes - 255 * scale.color(numbers)).max() < 1.5


def pixel_errors(image: Image) -> NDArray[np.float64]:
    mean = image.radiance.mean(dtype=np.float64)
    levels = squared_levels(image.radiance, image.stderr)
    ratio = image.stderr.astype(np.float64) ** 2 / (levels + 0.01 * mean**2)
    return np.asarray(np.sqrt(ratio.mean(axis=2)))


@pytest.mark.parametrize("relit", [False, True])
@pytest.mark.parametrize("layering", ["none", "groups"])
def test_the_error_of_a_pixel_is_its_share_in_that_of_the_picture(
    context: Context, layering: Layering, relit: bool
) -> None:
    with traced(context, room(warm=1.0, cold=1.0), 9, layering) as renderer:
        if relit:
            renderer.update(with_lights(renderer.scene, {"warm": 0.25, "cold": 3.0}))
            renderer.render(9)
        image = renderer.image()
        mean = float(image.radiance.mean(dtype=np.float64))
        weights = renderer.plan.weights
        assert (weights != (ONE,)) == (relit and layering == "groups")
        codes = drawn(
            renderer, lambda colors, light: colors.draw_error(renderer.film, light, weights, mean)
        )
    errors = pixel_errors(image)
    by_own = np.square(image.radiance, dtype=np.float64)
    assert (squared_levels(image.radiance, image.stderr) < 0.5 * by_own).any(), "some are lucky"
    assert np.sqrt((errors**2).mean()) == pytest.approx(image.error)
    assert len(np.unique(codes)) > 50
    assert_drawn(codes, ERROR, errors)


def test_without_two_observations_the_error_is_grey(context: Context) -> None:
    with traced(context, room(), 1) as renderer:
        codes = drawn(
            renderer, lambda colors, light: colors.draw_error(renderer.film, light, (ONE,), 1.0)
        )
    assert (np.abs(codes.astype(int) - 127) <= 1).all()


def test_numbers_of_history_are_drawn_and_none_is_grey(context: Context) -> None:
    with traced(context, room(), 1) as renderer:
        rng = np.random.default_rng(4)
        numbers = np.zeros((SIZE["height"], SIZE["width"], 4), np.float32)
        numbers[..., 3] = rng.uniform(1.5, 80, numbers.shape[:2])
        numbers[3:5, :, 3] = 1.0
        with context.gl:
            texture = context.gl.texture(renderer.size, 4, numbers.tobytes(), dtype="f4")
        told = Told(texture, 1.0)
        codes = drawn(
            renderer,
            lambda colors, light: colors.draw_history(renderer.film, light, told, HISTORY),
        )
        texture.release()
    assert (np.abs(codes[3:5].astype(int) - 127) <= 1).all()
    assert_drawn(codes[5:], HISTORY, numbers[5:, :, 3])


def test_dropped_samples_are_marked_where_they_fell(context: Context) -> None:
    with traced(context, room(), 64) as renderer:
        with context.gl:
            mean = np.frombuffer(renderer.film.mean.read(), np.float32).copy()
            pixels = mean.reshape(SIZE["height"], SIZE["width"], 4)
            pixels[5, 7, 3], pixels[15, 20, 3] = 63, 24  # finite ones, of 64
            renderer.film.mean.write(mean.tobytes())
        codes = drawn(renderer, lambda colors, light: colors.draw_dropped(renderer.film, light))
    marked = codes[..., 0] != codes[..., 2]
    expected = np.zeros(marked.shape, bool)
    expected[4:7, 6:9] = expected[14:17, 19:22] = True
    assert (marked == expected).all()
    assert_drawn(codes[5, 7], DROPPED, 1)
    assert_drawn(codes[15, 20], DROPPED, 40)
    assert codes[~marked].std() > 1, "the picture shows dimly below"


def test_a_difference_at_the_same_seeds_is_white_where_nothing_changed(context: Context) -> None:
    scale = symmetric(DIFFERENCE, 0.25)
    with traced(context, room(0.9), 4) as before, traced(context, room(0.2), 4) as after:
        old, new = before.image(), after.image()
        mean = float(old.radiance.mean(dtype=np.float64))
        codes = drawn(
            after,
            lambda colors, light: colors.draw_difference(
                after.film, light, before.film.mean, mean, scale
            ),
        )
    here, there = (image.radiance.astype(np.float64) @ LUMINANCE for image in (new, old))
    difference = (here - there) / np.sqrt(there**2 + 0.01 * mean**2)
    assert_drawn(codes, scale, difference)
    same = (new.radiance == old.radiance).all(axis=2)
    assert same.mean() > 0.1
    white = np.round(255 * np.array(BLUE_WHITE_RED[5]))
    assert (np.abs(codes[same] - white) <= 1).all()
    darker = codes[difference < -0.2]
    assert len(darker) > 10
    assert (darker[:, 2] > darker[:, 0]).all(), "blue is darker than before"


def test_scales_have_their_colours_at_their_ends_and_none_beyond() -> None:
    assert ERROR.color([0.0, 0.001]).tolist() == [list(VIRIDIS[0])] * 2
    assert ERROR.color([1.0, 7.0]).tolist() == [list(VIRIDIS[-1])] * 2
    assert ERROR.share(0.1) == pytest.approx(2 / 3)
    assert DIFFERENCE.color(0.0) == pytest.approx(BLUE_WHITE_RED[5])
    assert symmetric(DIFFERENCE, 2.0).share(1.0) == 0.75


def test_error_colours_grow_lighter_in_even_steps() -> None:
    """Lightness L* of CIE 1976: even within a fifth, so that a step looks like a step anywhere."""
    linear = ((np.array(VIRIDIS) + 0.055) / 1.055) ** 2.4
    steps = np.diff(116 * np.cbrt(linear @ LUMINANCE) - 16)
    assert steps.min() > 0.8 * steps.mean()
    assert steps.max() < 1.2 * steps.mean()


def test_a_shader_that_the_driver_refuses_is_reported_by_file_and_line(
    context: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The window goes on with its picture, as with any other shader."""
    path = folder("shaders_glsl") / "false_colors.frag"
    monkeypatch.setitem(glsl._texts, path, "void main() { undeclared = 1; }\n")
    with traced(context, room(), 1) as renderer, context.gl:
        colors = FalseColors(context.gl)
        with pytest.raises(RenderError, match=r"false_colors\.frag:1"):
            colors.draw_dropped(renderer.film, renderer.film.mean)
