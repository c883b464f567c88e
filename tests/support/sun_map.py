"""A scene under an image of the sky whose light comes mostly from a small sun."""

from typing import Any

import numpy as np

from glrt.scene.files.named_images import ImageFile
from glrt.scene.lights.background import Background
from glrt.scene.scene import Scene
from tests.support.builders import glass, plane, scene_of, sphere

SUN = np.array([0.55, 0.77, 0.33])  # direction to the sun, of length 1 within 1 %
RADIUS = 2.0  # degrees
RADIANCE = 8000.0
_HEIGHT, _WIDTH = 128, 256


def sky() -> Any:
    """Radiance of the sky, (H, W, 3) float32: blue, grey below the horizon, and the sun."""
    polar = (np.arange(_HEIGHT) + 0.5) / _HEIGHT * np.pi
    around = (np.arange(_WIDTH) + 0.5) / _WIDTH * 2 * np.pi
    up = np.cos(polar)[:, None] * np.ones(_WIDTH)
    level = np.sin(polar)[:, None]
    towards = np.stack([level * np.sin(around), up, -level * np.cos(around)], axis=-1)
    colors = np.where(up[..., None] > 0, [0.2, 0.35, 0.7], [0.2, 0.18, 0.15])
    is_sun = towards @ (SUN / np.linalg.norm(SUN)) > np.cos(np.radians(RADIUS))
    colors[is_sun] = RADIANCE
    return colors.astype(np.float32)


def even_sky() -> Scene:
    """The same balls under a gradient from grey to blue."""
    gradient = Background(bottom=(0.5, 0.5, 0.5), top=(0.5, 0.7, 1.0))
    return sun_map().model_copy(update={"background": gradient})


def sun_map() -> Scene:
    """Balls of rough glass, clear glass and rough metal on a floor under such a sky."""
    materials: dict[str, Any] = {
        "floor": {"type": "lambertian", "color": [0.6] * 3},
        "rough": glass(roughness=0.25),
        "clear": glass(),
        "metal": {"type": "metal", "color": [0.9, 0.8, 0.5], "roughness": 0.2},
    }
    things = [
        plane([0, 0, 0], [0, 1, 0], "floor"),
        sphere([-1.2, 0.7, 0], 0.7, "rough"),
        sphere([1.2, 0.7, 0], 0.7, "metal"),
        sphere([0, 0.4, 1.2], 0.4, "clear"),
    ]
    camera = {"position": [0, 2.2, 5], "look_at": [0, 0.5, 0], "fov": 40}
    scene = scene_of(things, materials, camera, background={"image": "sky.exr"})
    image = ImageFile(file="sky.exr").read_as("5" * 64, sky(), None)
    background = scene.background.model_copy(update={"image": image})
    return scene.model_copy(update={"background": background})
