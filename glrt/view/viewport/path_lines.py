"""Paths as lines in the scene, and a camera that sees them from outside."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.rendering.paths.values import Path
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.scene.values import Vector

Array = NDArray[np.float64]
Kind = Literal["path", "escape", "sampled", "hidden", "linked"]

FOV = 40.0  # degrees, of the view from outside


class Line(NamedTuple):
    """A line from one place to another, (3,) each, in scene units."""

    start: Array
    end: Array
    kind: Kind


class Ball(NamedTuple):
    """A ball around some points, in scene units."""

    center: Array
    radius: float


def lines_of(path: Path, reach: float, eye: Vector) -> list[Line]:
    """Return the segments of a path; lines out of the scene and to suns are as long as `reach`.

    A particle also has lines from its linked vertices to the camera at `eye`.
    """
    places = [np.array(vertex.position) for vertex in path.vertices]
    lines = [Line(start, end, "path") for start, end in pairwise(places)]
    last = path.vertices[-1]
    if path.end == "left the scene" and last.direction is not None:
        lines.append(Line(places[-1], places[-1] + reach * np.array(last.direction), "escape"))
    if path.particle is not None:
        links = dict.fromkeys(light.vertex for light in path.contributions)
        return [*lines, *(Line(places[at], np.array(eye), "linked") for at in links)]
    return [*lines, *_sampled(path, places, reach)]


def _sampled(path: Path, places: list[Array], reach: float) -> Iterator[Line]:
    """Yield lines from vertices to the points on lamps that were sampled there."""
    for light in path.contributions:
        if light.strategy == "light sampling" and light.direction is not None:
            is_near = light.distance is not None and math.isfinite(light.distance)
            length = min(light.distance or reach, 1e6 * reach) if is_near else reach
            start = places[light.vertex]
            end = start + length * np.array(light.direction)
            yield Line(start, end, "hidden" if light.hidden else "sampled")


def surroundings(scene: Scene, path: Path) -> Ball:
    """Return a ball around the camera, the path, and the middles of finite objects near them."""
    points = [np.array(vertex.position) for vertex in path.vertices]
    points += [np.array(scene.camera.position), np.array(scene.camera.look_at)]
    center = np.mean(points, axis=0)
    usual = max(float(np.linalg.norm(np.ptp(points, axis=0))), 1e-9)
    for shape in scene.visible:
        away = float(np.linalg.norm(np.array(shape.middle) - center))
        if math.isfinite(shape.reach) and away + shape.reach < 3 * usual:
            points += [np.array(shape.middle)]
    low, high = np.min(points, axis=0), np.max(points, axis=0)
    return Ball((low + high) / 2, max(float(np.linalg.norm(high - low)) / 2, 1e-9))


def outside(ball: Ball, yaw: float, pitch: float) -> Camera:
    """Return a camera that sees all of a ball; angles in degrees, about y and above the ground."""
    turn, rise = math.radians(yaw), math.radians(pitch)
    towards = np.array(
        [math.cos(rise) * math.sin(turn), math.sin(rise), math.cos(rise) * math.cos(turn)]
    )
    distance = 1.1 * ball.radius / math.sin(math.radians(FOV) / 2)
    position, center = (
        (float(x), float(y), float(z))
        for x, y, z in (ball.center + distance * towards, ball.center)
    )
    return Camera(position=position, look_at=center, fov=FOV)
