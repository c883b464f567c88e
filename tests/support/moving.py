"""Views that differ by a camera, and what was shown of them, for tests of temporal modes."""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from glrt.analysis.motion.playing import read_texture
from glrt.gpu.canvas import Canvas
from glrt.gpu.context import Context
from glrt.rendering.history.drawn_pass import DrawnPass
from glrt.rendering.history.gbuffer import SurfacePass, Surfaces
from glrt.rendering.history.reprojection import Limits, Reprojection
from glrt.rendering.history.temporal import Mode, Temporal, Way
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import settings_for
from tests.support.builders import MATTE, lamp, plane, quad, scene_of

Floats = NDArray[Any]
FOV = 2 * math.degrees(math.atan(0.5))  # the picture is as high as it is far
UNLIMITED = Limits(1e6, 1e6, 1e6)


def wall(x: float = 0.0, y: float = 0.0, **more: Any) -> Scene:
    """A matte plane a unit away, straight ahead, under even light; the camera is moved aside."""
    camera = {"position": [x, y, 1.0], "look_at": [x, y, 0.0], "fov": FOV}
    materials = {"matte": MATTE, "lamp": lamp(4.0)}
    sky = {"background": {"color": [1.0, 1.0, 1.0]}}
    return scene_of([plane([0, 0, 0], [0, 0, 1], "matte")], materials, camera, **{**sky, **more})


def two_walls(x: float, **more: Any) -> Scene:
    """A quad at half the distance of a wall, whose right edge is seen in the middle from x = 0."""
    objects = [
        plane([0, 0, 0], [0, 0, 1], "matte"),
        quad([-3, -3, 0.5], [3, 0, 0], [0, 6, 0], "matte"),
    ]
    camera = {"position": [x, 0.0, 1.0], "look_at": [x, 0.0, 0.0], "fov": FOV}
    return scene_of(objects, {"matte": MATTE}, camera, **more)


def textures_of(context: Context, *textures: moderngl.Texture) -> list[Floats]:
    """Float textures as arrays, (H, W, 4) each."""
    with context.gl:
        return [read_texture(texture).copy() for texture in textures]


@contextmanager
def view(scene: Scene, context: Context, size: tuple[int, int]) -> Iterator[Surfaces]:
    """The surfaces of a scene at a size."""
    renderer = Renderer(scene, None, context, width=size[0], height=size[1])
    found, fill = Surfaces(context.gl), SurfacePass(context.gl)
    fill.fill(renderer, found)
    yield found
    for part in (found, fill, renderer):
        part.release()


def brought(
    before: Scene,
    now: Scene,
    history: Floats,
    context: Context,
    limits: Limits = UNLIMITED,
    size: tuple[int, int] | None = None,
) -> Floats:
    """A history (H, W, 4) of the view before as that of now gets it, at a `size` of its own."""
    height, width, _ = history.shape
    with (
        view(before, context, (width, height)) as old,
        view(now, context, size or (width, height)) as new,
    ):
        reprojection = Reprojection(context.gl, limits)
        with context.gl:
            texture = context.gl.texture(
                (width, height), 4, history.astype("f4").tobytes(), dtype="f4"
            )
            result = read_texture(reprojection.bring(new, old, texture)).copy()
            texture.release()
            reprojection.release()
    return result


def samples_shown(
    scenes: Sequence[Scene], mode: Mode, size: tuple[int, int], context: Context
) -> Floats:
    """Samples that each pixel stands for, (H, W), after a sample of each scene in turn."""
    settings = settings_for(scenes[0].render, width=size[0], height=size[1], bounces=2)
    renderer, temporal = Renderer(scenes[0], settings, context), Temporal(context.gl, Way(mode))
    for scene in scenes:
        temporal.leave(renderer)
        renderer.update(scene)
        temporal.arrive(renderer)
        renderer.render(1)
    told = temporal.told(renderer, "history")
    assert told
    assert told.texture
    with context.gl:
        counts: Floats = read_texture(told.texture)[..., 3].copy()
    temporal.release()
    renderer.release()
    return counts


def noise(size: tuple[int, int], seed: int = 0) -> Floats:
    """A history of random radiance, and of 1 to 9 samples."""
    rng = np.random.default_rng(seed)
    light = rng.uniform(0, 1, (size[1], size[0], 3))
    counts = rng.integers(1, 10, (size[1], size[0], 1))
    return np.concatenate([light, counts], axis=2).astype(np.float32)


def drawn(
    shader: str,
    arrays: dict[str, Floats],
    values: dict[str, float],
    size: tuple[int, int],
    context: Context,
) -> Floats:
    """The picture that a shader draws of textures, (H, W, 4)."""
    with context.gl:
        canvas, over = Canvas(context.gl, "f4"), DrawnPass(context.gl, shader)
        textures = {
            name: context.gl.texture(array.shape[1::-1], 4, array.tobytes(), dtype="f4")
            for name, array in arrays.items()
        }
        over.draw(canvas.sized(size), textures, values)
        assert canvas.texture
        found: Floats = read_texture(canvas.texture).copy()
        canvas.release()
        over.release()
        for texture in textures.values():
            texture.release()
    return found
