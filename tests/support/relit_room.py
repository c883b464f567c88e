"""A room whose light is changed without a new render."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import moderngl
import numpy as np

from glrt.gpu.context import Context
from glrt.image.image import Pixels
from glrt.plan.plan import Layering, Weights
from glrt.rendering.renderer import Renderer
from glrt.scene.materials.light import Light
from glrt.scene.scene import Scene
from glrt.view.controls import replaced
from tests.support.builders import MATTE, quad, room_of_planes, scene_of, sphere

LAMPS = {
    "warm": {"type": "light", "emission": [4.0, 2.0, 0.5]},
    "cold": {"type": "light", "emission": [0.5, 1.0, 6.0]},
}
ROOM = [
    *room_of_planes("white"),
    sphere([0.4, -0.6, -0.4], 0.4, "white"),
    quad([-0.9, 0.9, -0.9], [0.5, 0, 0], [0, 0, 0.5], "warm"),
]
OTHER = quad([0.4, 0.9, -0.9], [0.5, 0, 0], [0, 0, 0.5], "cold")


def room(lamps: int = 1, sky: float = 0.0, **lights: float) -> Scene:
    """A closed room with one lamp or two; a sky is seen through the missing wall behind."""
    objects = [*ROOM, OTHER] if lamps > 1 else ROOM
    objects = objects[:5] + objects[6:] if sky else objects
    names = ["warm", "cold"][:lamps]
    materials = {"white": MATTE, **{name: LAMPS[name] for name in names}}
    background = {"background": {"color": [sky, sky, 2 * sky]}} if sky else {}
    return scene_of(objects, materials, lights=lights, **background)


@contextmanager
def layered(
    scene: Scene, context: Context, layering: Layering = "groups", **settings: Any
) -> Iterator[Renderer]:
    size = {"width": 16, "height": 16, "bounces": 4, **settings}
    renderer = Renderer(scene, context=context, layering=layering, **size)
    try:
        yield renderer
    finally:
        renderer.release()


def radiance(renderer: Renderer) -> Pixels:
    return renderer.image().radiance


def tinted(scene: Scene, name: str, emission: tuple[float, float, float]) -> Scene:
    material = scene.materials[name]
    assert isinstance(material, Light)
    return replaced(
        scene, materials={**scene.materials, name: replaced(material, emission=emission)}
    )


def seen(renderer: Renderer, weights: Weights) -> Pixels:
    """The texture that the display pass gets."""
    with renderer.context.gl:
        texture: moderngl.Texture = renderer.weighed(weights)
        width, height = texture.size
        return np.frombuffer(texture.read(), np.float32).reshape(height, width, 4)[..., :3].copy()
