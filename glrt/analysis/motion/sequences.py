"""The scenes of a moving picture, frame by frame: fixed, so that each run shows the same."""

import math
from typing import NamedTuple

import numpy as np

from glrt.scene.camera import Camera
from glrt.scene.scene import Scene


class Sequence(NamedTuple):
    """A scene for each frame; a frame with the same scene as the one before adds samples to it."""

    name: str
    scenes: tuple[Scene, ...]
    first: int = 0  # frame to look at


def orbit(scene: Scene, frames: int, degrees: float) -> Sequence:
    """The camera swings around the point that it looks at, by `degrees` a frame.

    It goes to one side for a quarter of the frames, to the other for a half, and back. So it ends
    near its start, and stays near the place that the scene was made to be seen from.
    """
    angles = [math.radians(degrees * _swing(frame, frames)) for frame in range(frames)]
    return Sequence("orbit", tuple(with_camera(scene, turned(scene.camera, a)) for a in angles))


def light_step(scene: Scene, frames: int, at: int, factor: float) -> Sequence:
    """A still camera; from frame `at` on, `factor` scales the intensity of all lights."""
    groups = {finish.group for finish in scene.finishes if finish.group}
    lights = {name: factor * scene.lights.get(name, 1.0) for name in sorted(groups)}
    after = scene.model_copy(update={"lights": {**scene.lights, **lights}})
    return Sequence("light step", tuple(scene if n < at else after for n in range(frames)), at)


def with_camera(scene: Scene, camera: Camera) -> Scene:
    """The same scene, seen by another camera."""
    return scene.model_copy(update={"camera": camera})


def turned(camera: Camera, angle: float) -> Camera:
    """A camera moved on a circle about +y around the point that it looks at; in radians."""
    middle = np.array(camera.look_at, np.float64)
    x, y, z = np.array(camera.position, np.float64) - middle
    cos, sin = math.cos(angle), math.sin(angle)
    place = middle + np.array([cos * x + sin * z, y, cos * z - sin * x])
    return camera.model_copy(update={"position": tuple(place.tolist())})


def pixels_a_frame(scene: Scene, height: int, degrees: float) -> float:
    """Speed of the picture in an orbit, in pixels a frame, at half the distance of its centre."""
    camera = scene.camera
    tall = 2 * math.tan(math.radians(camera.fov) / 2)
    return height * math.radians(degrees) / tall


def _swing(frame: int, frames: int) -> float:
    """Steps from the start: a triangle wave with a period of `frames`."""
    quarter = frames / 4
    return quarter - abs((frame + quarter) % frames - 2 * quarter)
