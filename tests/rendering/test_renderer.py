"""Portions, crops, sizes and seeds: what a picture depends on, and what it does not."""

from itertools import pairwise, product
from typing import Any

import moderngl
import numpy as np
import pytest

from glrt.core.errors import RenderError, UsageError
from glrt.gpu.context import Context, open_context
from glrt.gpu.program import Kernel
from glrt.rendering.device_scene import DeviceScene
from glrt.rendering.renderer import Renderer
from tests.support.builders import box_of_quads, lamp, plane, quad, room_of_planes, scene_of, sphere
from tests.support.images import same_bits
from tests.support.mixed_scene import OBJECTS, everything
from tests.support.renders import METHODS, rendered, rendering, same


@pytest.mark.parametrize("method", METHODS)
def test_samples_may_come_in_any_portions(context: Context, method: str) -> None:
    pictures = []
    for portions in ([16], [1] * 16, [3, 8, 1, 4], [1, 15]):
        with rendering(everything(), context, method=method, width=21, height=13) as renderer:
            for samples in portions:
                renderer.step(samples)
            pictures.append(renderer.image())
    assert pictures[0].samples == 16
    assert (pictures[0].stderr > 0).any()
    for picture in pictures[1:]:
        assert same(picture, pictures[0])


WALLS = {f"wall {i}": lamp(1.0 + i, 1.0) for i in range(8)}
ROOMS = {
    "spheres": [sphere([0.1, 0, 0], 2, ""), sphere([0.5, 0.3, 0.1], 0.5, "")],
    "planes": room_of_planes(""),
    "shapes of every kind": [
        *box_of_quads(""),
        plane([0, -2, 0], [0, 1, 0], ""),
        sphere([5, 0, 0], 2, ""),
    ],
}


@pytest.mark.slow_cases("mis-shapes of every kind")
@pytest.mark.parametrize("room", ROOMS)
@pytest.mark.parametrize("method", ["naive", "mis"])
def test_dispatch_of_the_most_samples_loses_no_round_of_a_loop(
    context: Context, room: str, method: str
) -> None:
    """Every path has all its 1001 segments: a driver that ends loops early drops the last samples.

    Walls of different lamps, for the mean of equal samples would not show it.
    """
    objects = [{**shape, "material": f"wall {i}"} for i, shape in enumerate(ROOMS[room])]
    settings = {"method": method, "roulette": False, "bounces": 1000, "width": 8, "height": 8}
    pictures = []
    for at_once in (True, False):
        with rendering(scene_of(objects, WALLS), context, **settings) as renderer:
            most = min(renderer.most_samples, 64)
            for count in [most] if at_once else [1] * most:
                renderer.step(count)
            pictures.append(renderer.image())
    assert same(*pictures)


def test_the_name_of_a_scene_is_not_taken_for_one() -> None:
    name: Any = "cornell"
    with pytest.raises(UsageError, match=r"a Scene is wanted, got 'cornell': glrt\.load reads"):
        Renderer(name)


def test_dispatch_of_the_most_samples_equals_single_ones(context: Context) -> None:
    """The case is a closed room with light sampling: two rays a segment, over seven shapes."""
    walls = room_of_planes("white")
    panel = quad([-0.5, 0.9, -0.5], [1, 0, 0], [0, 0, 1], "lamp")
    materials = {"white": {"type": "lambertian", "color": [0.9] * 3}, "lamp": lamp(2.0)}
    pictures = []
    for at_once in (True, False):
        scene = scene_of([*walls, panel], materials)
        with rendering(scene, context, method="mis", roulette=False, bounces=250) as renderer:
            most = min(renderer.most_samples, 16)
            for count in [most] if at_once else [1] * most:
                renderer.step(count)
            pictures.append(renderer.image())
    assert same(*pictures)


@pytest.mark.parametrize("samples", [0, -1, 1 << 30])
def test_step_refuses_more_samples_than_a_dispatch_takes(context: Context, samples: int) -> None:
    with rendering(everything(), context) as renderer:
        with pytest.raises(UsageError, match=f"1 to {renderer.most_samples} samples"):
            renderer.step(samples)
        assert renderer.samples == 0


def test_film_without_a_sample_has_no_image(context: Context) -> None:
    with rendering(everything(), context) as renderer, pytest.raises(RenderError, match="empty"):
        renderer.image()


@pytest.mark.parametrize(
    ("frame", "crop"),
    [
        ((40, 24), (0, 0, 8, 8)),
        ((37, 23), (5, 3, 17, 11)),
        ((37, 23), (36, 22, 1, 1)),
        ((37, 23), (0, 0, 37, 23)),
        ((1, 1), (0, 0, 1, 1)),
        ((257, 3), (251, 1, 6, 2)),
        ((257, 3), (1, 0, 255, 1)),
        ((3, 257), (1, 100, 1, 150)),
    ],
)
def test_crop_is_that_part_of_the_frame(
    context: Context, frame: tuple[int, int], crop: tuple[int, int, int, int]
) -> None:
    settings = {"width": frame[0], "height": frame[1]}
    full = rendered(everything(), context, 4, **settings)
    part = rendered(everything(), context, 4, crop=crop, **settings)
    left, top, width, height = crop
    here = slice(top, top + height), slice(left, left + width)
    assert part.radiance.shape == (height, width, 3)
    assert same_bits(part.radiance, full.radiance[here].copy())
    assert same_bits(part.stderr, full.stderr[here].copy())


def test_two_crops_joined_are_the_frame(context: Context) -> None:
    size = {"width": 37, "height": 23}
    parts = [
        rendered(everything(), context, 4, crop=crop, **size)
        for crop in ((0, 0, 13, 23), (13, 0, 24, 23))
    ]
    full = rendered(everything(), context, 4, **size)
    assert same_bits(np.hstack([part.radiance for part in parts]), full.radiance)
    assert same_bits(np.hstack([part.stderr for part in parts]), full.stderr)


def test_small_frame_is_made_of_its_pixels(context: Context) -> None:
    full = rendered(everything(), context, 3, width=7, height=5)
    with rendering(everything(), context, width=7, height=5) as renderer:
        for y, x in np.ndindex(5, 7):
            renderer.update(crop=(x, y, 1, 1))
            pixel = renderer.render(3).image()
            assert same_bits(pixel.radiance[0, 0], full.radiance[y, x])


def test_frames_of_any_size_show_the_same_view(context: Context) -> None:
    """Pixels are square: a wall of lamp fills every frame, whatever its size."""
    wall = scene_of([plane([0, 0, -1], [0, 0, 1], "lamp")], {"lamp": lamp(0.75)})
    for width, height in [(1, 1), (7, 5), (257, 3), (8, 9), (64, 1)]:
        image = rendered(wall, context, 2, width=width, height=height)
        assert image.radiance.shape == (height, width, 3)
        assert (image.radiance == 0.75).all()


def test_frames_differ_and_share_no_noise(context: Context) -> None:
    """Beyond 3 / sqrt(pixels) is one of 370 independent pairs, beyond 4 one of 16,000.

    Shifted by a pixel too: seeds that add up place and frame show there alone. In all, 36 pairs:
    chance fails one seed in 50.
    """
    floor = [plane([0, -1, 0], [0, 1, 0], "white")]
    down = {"position": [0, 0, 0], "look_at": [0, -1, 0.01], "fov": 0.01}
    scene = everything([*floor, OBJECTS[3]], down)
    frames, mean = [], np.zeros((64, 64))
    with rendering(scene, context, width=64, height=64, method="mis") as renderer:
        for index in range(1, 8):
            renderer.step(1)
            now = renderer.image().radiance[..., 0].astype(np.float64)
            frames.append(index * now - (index - 1) * mean)
            mean = now
    for before, after in pairwise(frames):
        assert np.abs(before - after).max() > 0.1
        assert abs(correlation(before, after)) < 3 / 64
        for step, axis in product([1, -1], [0, 1]):
            assert abs(correlation(before, np.roll(after, step, axis))) < 4 / 64
    for frame, axis in product(frames[:3], [0, 1]):
        assert abs(correlation(frame, np.roll(frame, 1, axis))) < 4 / 64


def correlation(a: np.ndarray[Any, Any], b: np.ndarray[Any, Any]) -> float:
    return float(np.corrcoef(a.ravel(), b.ravel())[0, 1])


def test_same_seed_gives_the_same_bits_and_another_does_not(context: Context) -> None:
    first, again, other = (rendered(everything(), context, 3, seed=seed) for seed in (4, 4, 5))
    assert same(first, again)
    assert not same_bits(first.radiance, other.radiance)


def test_error_falls_with_the_root_of_the_samples(context: Context) -> None:
    """The truth is the closed form of a lamp in the centre of a matte ball."""
    materials = {"wall": {"type": "lambertian", "color": [0.6] * 3}, "lamp": lamp(3.0, 0.5)}
    objects = [sphere([0, 0, 0], 2, "wall"), sphere([0, 0, 0], 0.7, "lamp")]
    eye = {"position": [0.2, 0.1, 1.2], "look_at": [0.5, 1, 3]}
    errors = []
    scene = scene_of(objects, materials, eye)
    settings = {"method": "naive", "bounces": 1, "width": 32, "height": 32}
    with rendering(scene, context, **settings) as r:
        for power in range(11):
            image = r.render(2**power).image()
            errors.append(np.sqrt(np.square(image.radiance[..., 0] / 0.2205 - 1).mean()))
    slope = np.polyfit(range(11), np.log2(errors), 1)[0]
    assert slope == pytest.approx(-0.5, abs=0.05)
    assert errors[0] > 1


def test_a_renderer_that_is_refused_leaves_no_context_open(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    opened: list[Context] = []

    def opening(*choice: Any) -> Context:
        opened.append(open_context(*choice))
        return opened[-1]

    monkeypatch.setattr("glrt.rendering.renderer.open_context", opening)
    with pytest.raises(RenderError, match="along an edge"):
        Renderer(everything(), layering="lengths", width=16384, height=16)
    assert isinstance(opened[0].gl.mglo, moderngl.InvalidObject)


def test_a_context_that_was_given_stays_open_when_a_renderer_is_refused(context: Context) -> None:
    with pytest.raises(RenderError, match="along an edge"):
        Renderer(everything(), None, context, layering="lengths", width=16384, height=16)
    assert rendered(everything(), context, 1).samples == 1


@pytest.mark.parametrize("place", ["kernel", "scene"])
def test_an_error_of_the_driver_ends_a_render_before_it_begins(
    context: Context, fresh: Context, monkeypatch: pytest.MonkeyPatch, place: str
) -> None:
    """The picture may be wrong. An error that others left in the context does not end it."""

    def fails(self: Any, *arguments: Any) -> Any:
        done = uploading(self, *arguments)
        context.gl.enable_direct(0x1234)
        return done

    with context.gl:
        context.gl.enable_direct(0x1234)
    with rendering(everything(), context) as plain:
        plain.render(1)
        whole = {"kernel": (Kernel, "run_tiles"), "scene": (DeviceScene, "_upload")}[place]
        uploading = getattr(*whole)
        monkeypatch.setattr(*whole, fails)
        with pytest.raises(RenderError, match=r"the driver refuses .* GL_INVALID_ENUM"):
            rendered(everything(), fresh)
        monkeypatch.undo()
        assert plain.render(3).samples == 3


@pytest.mark.parametrize("samples", [0, 2])
def test_as_many_samples_as_are_asked_for_even_none(context: Context, samples: int) -> None:
    with rendering(everything(), context, samples=5) as plain:
        assert plain.render(samples).samples == samples
        assert plain.advance(10.0, samples) is False
        assert plain.samples == samples
        assert plain.render().samples == 5
        assert plain.render(samples).samples == 5, "up to so many in all"
