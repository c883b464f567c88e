"""The first surface behind a pixel, in float64: the truth for AOVs.

Written without the product's geometry: only the fields of the scene are read.
"""

import math
from typing import Any, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from glrt.gpu.context import Context
from glrt.image.aovs import AovImage, AovImages
from glrt.scene.camera import Camera
from glrt.scene.scene import Scene
from glrt.scene.shapes.quad import Quad
from glrt.scene.shapes.sphere import Sphere
from glrt.settings import OF_PATHS, Aov
from tests.support.alarms import ALPHA, book
from tests.support.images import same_bits
from tests.support.numerics import roots64
from tests.support.renders import interval, rendered
from tests.support.z_scores import z_test

ALL: tuple[Aov, ...] = tuple(aov for aov in get_args(Aov) if aov not in OF_PATHS)
MEANS = ALL[:-1]  # AOVs that are means over samples

Floats = NDArray[np.float64]
Rule = tuple[Floats, Floats]  # places in the unit interval, and their weights


def gathered(scene: Scene, context: Context, samples: int = 4, **settings: Any) -> AovImages:
    """All AOVs of 8 x 8 pixels by independent numbers; `settings` override both."""
    usual = {"width": 8, "height": 8, "bounces": 0, "aov": ALL}
    return rendered(scene, context, samples, **{**usual, **settings}).aovs


# --- rays ------------------------------------------------------------------------------------


class FirstHits(NamedTuple):
    """The hit of each ray, (...) or (..., 3); where a ray meets nothing: NaN, and object 0."""

    object: NDArray[np.int64]  # 1 + its place in the scene file
    depth: Floats
    position: Floats
    normal: Floats  # towards the viewer


def axes_of(camera: Camera) -> tuple[Floats, Floats, Floats]:
    """Unit vectors to the right, up and forward."""
    forward = np.subtract(camera.look_at, camera.position)
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, camera.up)
    right = right / np.linalg.norm(right)
    return right, np.cross(right, forward), forward


def rays_through(camera: Camera, size: tuple[int, int], x: Floats, y: Floats) -> Floats:
    """Unit directions from a pinhole through places of the picture, in pixels from its corner."""
    right, up, forward = axes_of(camera)
    (width, height), tan = size, math.tan(math.radians(camera.fov) / 2)
    across = (2 * x / width - 1) * tan * width / height
    upward = (1 - 2 * y / height) * tan
    ways = forward + across[..., None] * right + upward[..., None] * up
    unit: Floats = ways / np.linalg.norm(ways, axis=-1, keepdims=True)
    return unit


def first_hits(scene: Scene, origin: Floats, directions: Floats) -> FirstHits:
    """The first hits of rays from one point, or each from its own."""
    nearest = np.full(directions.shape[:-1], np.inf)
    number = np.zeros(directions.shape[:-1], np.int64)
    normal = np.full(directions.shape, np.nan)
    for place, shape in enumerate(scene.objects, 1):
        distance, outward = _met(shape, origin, directions)
        is_nearer = distance < nearest  # NaN is not
        nearest, number[is_nearer] = np.where(is_nearer, distance, nearest), place
        normal = np.where(is_nearer[..., None], outward, normal)
    along = np.where(number > 0, nearest, np.nan)[..., None] * directions
    position = origin + along
    depth = (position - np.array(scene.camera.position)) @ axes_of(scene.camera)[2]
    towards = np.where((normal * directions).sum(axis=-1)[..., None] > 0, -normal, normal)
    return FirstHits(number, depth, position, towards)


def _met(shape: Any, origin: Floats, directions: Floats) -> tuple[Floats, Floats]:
    """Distance, not above 0 or NaN for a miss, and normal, of either side."""
    if isinstance(shape, Sphere):
        center = np.array(shape.center)
        near, far = roots64(center, np.array(shape.radius), origin, directions)[0]
        distance = np.where(near > 0, near, far)
        normal = (origin + distance[..., None] * directions - center) / shape.radius
        return np.where(distance > 0, distance, np.nan), normal
    is_quad = isinstance(shape, Quad)
    point = np.array(shape.corner if is_quad else shape.point)
    across = np.cross(shape.edge_u, shape.edge_v) if is_quad else np.array(shape.normal)
    normal = across / np.linalg.norm(across)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = ((point - origin) @ normal) / (directions @ normal)
        offset = origin + distance[..., None] * directions - point
    inside = distance > 0
    if is_quad:
        place = offset @ np.linalg.pinv(np.array([shape.edge_u, shape.edge_v]))
        inside &= ((place >= 0) & (place <= 1)).all(axis=-1)
    return np.where(inside, distance, np.nan), np.broadcast_to(normal, directions.shape)


def hits_of_centers(scene: Scene, size: tuple[int, int]) -> FirstHits:
    """The hits of rays through the middle of each pixel, from the middle of the lens."""
    x, y = np.meshgrid(np.arange(size[0]) + 0.5, np.arange(size[1]) + 0.5)
    eye = np.array(scene.camera.position)
    return first_hits(scene, eye, rays_through(scene.camera, size, x, y))


# --- means over pixels -------------------------------------------------------------------------


class PixelMeans(NamedTuple):
    """Means over the rays through each pixel that meet something."""

    coverage: Floats  # (H, W): their share
    depth: Floats  # (H, W)
    position: Floats  # (H, W, 3)
    normal: Floats  # (H, W, 3)


def smooth(nodes: int = 12) -> Rule:
    """Gauss and Legendre's, for pixels without an edge."""
    places, weights = np.polynomial.legendre.leggauss(nodes)
    return (places + 1) / 2, weights / 2


def even(nodes: int) -> Rule:
    """The middles of equal parts, for pixels with edges."""
    return (np.arange(nodes) + 0.5) / nodes, np.full(nodes, 1 / nodes)


def pixel_means(scene: Scene, size: tuple[int, int], rule: Rule) -> PixelMeans:
    """The means over the area of each pixel, seen from a pinhole."""
    places, weights = rule
    columns = np.arange(size[0])[:, None] + places
    rows = np.arange(size[1])[:, None] + places
    x, y = np.broadcast_arrays(columns[None, :, None, :], rows[:, None, :, None])
    eye = np.array(scene.camera.position)
    found = first_hits(scene, eye, rays_through(scene.camera, size, x, y))
    weight = weights[:, None] * weights * (found.object > 0)
    coverage = weight.sum(axis=(2, 3))

    def mean(values: Floats) -> Floats:
        share = weight if values.ndim == 4 else weight[..., None]
        total = (share * np.nan_to_num(values)).sum(axis=(2, 3))
        with np.errstate(invalid="ignore"):
            found: Floats = total / (coverage if total.ndim == 2 else coverage[..., None])
        return found

    return PixelMeans(coverage, mean(found.depth), mean(found.position), mean(found.normal))


# --- verdicts ----------------------------------------------------------------------------------


def assert_mean_is(
    aov: AovImage, truth: Floats, within: float, floor: float = 0.0, where: Any = Ellipsis
) -> None:
    """The z-test passes, and sees whatever is further than `within` from the truth."""
    assert aov.stderr is not None
    book()
    value, stderr = aov.value[where], aov.stderr[where]
    verdict = z_test(value, stderr, truth[where], ALPHA, floor)
    assert verdict, str(verdict)
    half = interval(verdict.tests) * np.maximum(stderr, floor)
    assert half.max() <= within, f"the test sees nothing below {half.max()}"


def same_aov(a: AovImage, b: AovImage) -> bool:
    """Whether value, standard error and counts agree in every bit."""
    pairs = [(a.value, b.value), (a.stderr, b.stderr)]
    pairs += [(a.count, b.count), (a.observations, b.observations)]
    return all(x is y if x is None or y is None else same_bits(x, y) for x, y in pairs)


def same_aovs(a: AovImages, b: AovImages) -> bool:
    """Whether both have the same AOVs, bit for bit."""
    return [*a] == [*b] and len(a) > 0 and all(same_aov(a[name], b[name]) for name in a)
