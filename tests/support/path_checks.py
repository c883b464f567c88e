"""Paths of three pixels for tests, and the geometry of what they meet, in float64."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from glrt.gpu.context import Context
from glrt.image.sources import load
from glrt.rendering.paths.values import Contribution, Path, PixelPaths
from glrt.scene.scene import Scene
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.sphere import Sphere
from tests.support.mixed_scene import everything
from tests.support.pixel_paths import replayed

PIXELS = [(3, 5), (9, 11), (11, 14)]
NEAR = 2e-5  # relative: some roundings of float32


def vector(values: Any) -> Any:
    """The vector in float64."""
    return np.array(values, np.float64)


def traced_cornell(context: Context) -> list[PixelPaths]:
    """One lamp, five walls, a matte and a glass ball, without roulette."""
    settings: Any = {"roulette": False, "samples": 64, "bounces": 6}
    return [replayed(load("cornell"), pixel, context, **settings) for pixel in PIXELS]


def traced_with_roulette(context: Context) -> list[PixelPaths]:
    """The same with roulette."""
    return [replayed(load("cornell"), pixel, context, samples=64) for pixel in PIXELS]


def traced_mixed(context: Context) -> list[PixelPaths]:
    """Two lamps, rough metal, glass and a sky, through a lens."""
    return [replayed(everything(), pixel, context) for pixel in PIXELS]


def paths(found: list[PixelPaths]) -> Iterator[tuple[Scene, Path]]:
    for each in found:
        yield from ((each.recipe.scene, path) for path in each.paths)


def lights(found: list[PixelPaths]) -> Iterator[tuple[Scene, Path, Contribution]]:
    for scene, path in paths(found):
        yield from ((scene, path, light) for light in path.contributions)


def off_surface(shape: Any, place: Any) -> float:
    """How far a place lies off a shape."""
    if isinstance(shape, Sphere):
        return float(abs(np.linalg.norm(place - shape.center) - shape.radius))
    point = shape.point if isinstance(shape, Plane) else shape.corner
    edges = () if isinstance(shape, Plane) else (vector(shape.edge_u), vector(shape.edge_v))
    normal = vector(shape.normal) if isinstance(shape, Plane) else np.cross(*edges)
    off = abs(np.dot(place - point, normal)) / np.linalg.norm(normal)
    for edge in edges:  # at right angles in these scenes
        share = np.dot(place - point, edge) / np.dot(edge, edge)
        off = max(off, -share, share - 1)
    return float(off)


def outward(shape: Any, place: Any) -> Any:
    if isinstance(shape, Sphere):
        return (place - shape.center) / shape.radius
    normal = (
        vector(shape.normal) if isinstance(shape, Plane) else np.cross(shape.edge_u, shape.edge_v)
    )
    return normal / np.linalg.norm(normal)


def crossed_between(shape: Any, start: Any, end: Any) -> bool:
    """Whether a shape stands clearly between two places."""
    if isinstance(shape, Sphere):
        along = (end - start) / np.linalg.norm(end - start)
        towards = vector(shape.center) - start
        middle = np.dot(towards, along)
        square = shape.radius**2 - (np.dot(towards, towards) - middle**2)
        roots = [middle - math.sqrt(square), middle + math.sqrt(square)] if square > 1e-6 else []
        return any(1e-3 < root < np.linalg.norm(end - start) - 1e-3 for root in roots)
    point = shape.point if isinstance(shape, Plane) else shape.corner
    normal = outward(shape, start)
    before, after = np.dot(start - point, normal), np.dot(end - point, normal)
    if before * after >= 0 or min(abs(before), abs(after)) < 1e-3:
        return False
    return off_surface(shape, start + (end - start) * before / (before - after)) < 1e-6
