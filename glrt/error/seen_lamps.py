"""The true light of lamps that the camera sees directly, in pixels that a lamp fills in part.

Such a pixel depends on how much of it the lamp covers. For a small sun, or at a rim, a few of its
samples decide, and no statistics of the samples show how lucky they were. The scene does: it holds
the place of the lamp. So the coverage is counted by separate rays, against the shapes themselves,
without the renderer.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.error.brightest_neighbour import brightest_around
from glrt.error.estimate import DARK
from glrt.scene.camera import Camera
from glrt.scene.materials.lambertian import Lambertian
from glrt.scene.materials.light import Light
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.settings import Settings

Pixels = NDArray[np.float32]
Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Indices = NDArray[np.intp]

MOST_SHAPES = 256  # in a scene: with more, no lamp is searched
MOST_PIXELS = 256  # of a picture: those whose error is largest
SMALL = 16  # pixels: a lamp that is not larger may have been met by no sample at all
TINY = 4.0  # pixels: the box around a lamp that few rays from the camera meet
LARGE = 1 << 18  # pixels: the rim of a larger lamp does not carry the error in single pixels
STEPS = 24  # rays along each side of the part of a pixel that may show a lamp
MORE_STEPS = 96  # where few of them meet it
CLEAR = 4.0  # times as bright as a pixel: a brighter neighbour may be a lamp
ALIKE = 0.25  # of a lamp's light in a pixel: other light around it may differ by less
UNLIKELY = 1e-6  # chance: if a pixel's brightness is less likely than that, it has other light
LEAST_HITS = 40  # of a lamp by rays through a pixel: fewer do not determine its share
SURE = 100  # hits: with more a pixel is known
PLAIN = (Lambertian, Light)  # materials behind which no lamp is seen


class Seen(NamedTuple):
    """Pixels of known true radiance: (n,) rows and columns, and the radiance, (n, 3)."""

    rows: Indices
    columns: Indices
    radiance: Array


class _Frame(NamedTuple):
    """A camera in the form that rays need, in scene units; `size` is the picture's in pixels."""

    position: Array
    axes: Array  # right, up, forward: rows
    tangents: Array  # (2,): of half the field of view
    lens_radius: float
    tan_lens: float
    size: Array  # width and height


class _Box(NamedTuple):
    """A rectangle of the frame in pixels: (2,) each, x and y."""

    low: Array
    high: Array


def seen_lamps(scene: Scene, settings: Settings, radiance: Pixels, stderr: Pixels) -> Seen:
    """The pixels that lamps fill in part and few samples lit, with their true radiance.

    `radiance` and `stderr`, (H, W, 3), are the rendered picture of the scene. All other light of a
    pixel is taken from the darkest of the nine pixels around it. The pixel is left out if these
    differ much compared to the lamp's light. A scene with meshes has no such pixels. Lamps with a
    cone, an image or one side are left out, and pixels where glass or a mirror may show a lamp too.
    """
    shapes = scene.visible
    nothing = Seen(np.zeros(0, np.intp), np.zeros(0, np.intp), np.zeros((0, 3)))
    if len(shapes) > MOST_SHAPES or any(isinstance(shape, Mesh) for shape in shapes):
        return nothing
    frame = _frame(scene.camera, settings)
    boxes = {n: _box(frame, s) for n, s in enumerate(shapes) if _shines(scene, s)}
    corner = np.array((settings.crop or (0, 0))[:2], np.float64)
    found = _candidates([box for box in boxes.values() if box], corner, radiance, stderr)
    parts = [_shown(scene, frame, boxes, corner, row, column) for row, column in found]
    kept = [(*place, *part) for place, part in zip(found, parts, strict=True) if part]
    if not kept:
        return nothing
    rows, columns, light, share = zip(*kept, strict=True)
    return _next_to(
        np.array(rows), np.array(columns), np.array(light), np.array(share), radiance, stderr
    )


def has_tiny_lamp(scene: Scene, settings: Settings) -> bool:
    """Whether a lamp within the frame covers at most TINY pixels, whatever stands before it."""
    frame = _frame(scene.camera, settings)
    boxes = (_box(frame, shape) for shape in scene.visible if _shines(scene, shape))
    return any(
        np.prod(box.high - box.low) <= TINY
        and (box.high > 0).all()
        and (box.low < frame.size).all()
        for box in boxes
        if box
    )


def _next_to(
    rows: Indices, columns: Indices, light: Array, share: Array, radiance: Pixels, stderr: Pixels
) -> Seen:
    """Fill the rest of each pixel, which lamps leave, with the darkest light around it.

    A pixel is left out if that light differs much compared to the lamps'. It also is if the picture
    is too bright there for luck: then there is other light.
    """
    about = [_around(radiance, y, x) for y, x in zip(rows, columns, strict=True)]
    darkest, usual = (np.array(part) for part in zip(*about, strict=True))
    is_clear = (usual - darkest <= ALIKE * light).all(axis=1)
    truth = light + (1 - share[:, None]) * darkest
    value, error = (part[rows, columns].astype(np.float64) for part in (radiance, stderr))
    is_clear &= (_log_chance(value, error, truth) >= math.log(UNLIKELY)).all(axis=1)
    return Seen(rows[is_clear], columns[is_clear], truth[is_clear])


def _log_chance(value: Array, error: Array, truth: Array) -> Array:
    """Logarithm of the chance that luck makes a pixel as bright; -inf without noise, 0 if darker.

    As if h = (value / error)^2 equal samples had lit it, where l = h truth / value were expected. A
    Poisson number of mean l is h or more with a chance of at most exp(h - l) (l / h)^h (Chernoff's
    bound).
    """
    share = np.divide(truth, value, out=np.ones_like(value), where=value > truth)
    with np.errstate(divide="ignore", invalid="ignore"):
        hits = np.square(value / error)
        chance = hits * (1 - share + np.log(share))
    return np.where(share < 1, chance, 0.0)


def _around(radiance: Pixels, row: int, column: int) -> tuple[Array, Array]:
    """The least of a pixel and its neighbours, and the third least of them, (3,) each."""
    about = radiance[max(row - 1, 0) : row + 2, max(column - 1, 0) : column + 2].reshape(-1, 3)
    ranks = np.sort(about.astype(np.float64), axis=0)
    return ranks[0], ranks[min(2, len(ranks) - 1)]


def _shines(scene: Scene, shape: Shape) -> bool:
    return any(scene.emission_of(shape)) and math.isfinite(shape.reach)


def _is_plain(scene: Scene, shape: Shape) -> bool:
    """Whether a lamp looks the same from everywhere."""
    material = scene.materials[shape.material]
    is_even = isinstance(material, Light) and not material.cone and not material.textures
    return is_even and not shape.is_one_sided


def _frame(camera: Camera, settings: Settings) -> _Frame:
    forward = _unit(np.array(camera.view))
    right = _unit(np.cross(forward, camera.up))
    tan_y = math.tan(math.radians(camera.fov) / 2)
    tan_lens = math.tan(math.radians(camera.defocus_angle) / 2)
    return _Frame(
        np.array(camera.position),
        np.array([right, np.cross(right, forward), forward]),
        np.array([tan_y * settings.width / settings.height, tan_y]),
        tan_lens * camera.resolved_focus_distance,
        tan_lens,
        np.array([settings.width, settings.height], np.float64),
    )


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.linalg.norm(vector))


def _box(frame: _Frame, shape: Shape) -> _Box | None:
    """Part of the picture that a lamp may cover, for all of the lens; None at or behind the eye."""
    x, y, depth = frame.axes @ (np.array(shape.middle) - frame.position)
    nearest = depth - shape.reach
    if nearest <= 0:
        return None
    place = np.array([x, y]) / depth
    ends = np.array([nearest, depth + shape.reach])
    blur = np.abs(frame.tan_lens - frame.lens_radius / ends).max()
    reach = shape.reach * (1 + np.abs(place)) / nearest + blur
    return _Box(*(_on_film(frame, place + sign * reach * [1, -1]) for sign in (-1, 1)))


def _on_film(frame: _Frame, slopes: Array) -> Array:
    """Pixel coordinates from the upper left corner, for slopes to the right and upwards."""
    return (slopes / frame.tangents * [1, -1] + 1) / 2 * frame.size


def _candidates(
    boxes: list[_Box], corner: Array, radiance: Pixels, stderr: Pixels
) -> list[tuple[int, int]]:
    """Rows and columns of pixels that lamps may fill in part; the MOST_PIXELS with most error."""
    floor = DARK * radiance.mean(dtype=np.float64) ** 2
    found: dict[tuple[int, int], float] = {}
    for box in boxes:
        ends = (np.floor(box.low - corner), np.ceil(box.high - corner))
        low, high = (np.clip(end, 0, radiance.shape[1::-1]).astype(int) for end in ends)
        area = int(np.prod(high - low))
        if area > LARGE:
            continue
        place = slice(low[1], high[1]), slice(low[0], high[0])
        is_beside = (brightest_around(radiance[place]) > CLEAR * radiance[place]).any(axis=2)
        squares = np.square(radiance[place], dtype=np.float64)
        variance = np.square(stderr[place], dtype=np.float64)
        is_wanted = (squares < SURE * variance).any(axis=2) | is_beside | (area <= SMALL)
        parts = (variance / np.maximum(squares + floor, 1e-300)).max(axis=2)
        for y, x in np.argwhere(is_wanted):
            found[int(y + low[1]), int(x + low[0])] = float(parts[y, x])
    return sorted(found, key=lambda one: -found[one])[:MOST_PIXELS]


def _shown(
    scene: Scene, frame: _Frame, boxes: dict[int, _Box | None], corner: Array, row: int, column: int
) -> tuple[Array, float] | None:
    """Mean light (3,) of lamps in a pixel, and their share of it; None if that is not known."""
    low = np.array([column, row]) + corner
    light, share = np.zeros(3), 0.0
    for number, box in boxes.items():
        if box is None:
            continue
        start, end = np.maximum(box.low, low), np.minimum(box.high, low + 1)
        if (start >= end).any():
            continue
        met = _met(scene.visible, frame, start, end, STEPS)
        if not all(
            _is_clear(scene, scene.visible[n], n in boxes) for n in np.unique(met[met >= 0])
        ):
            return None
        if 0 < (met == number).sum() < LEAST_HITS:
            met = _met(scene.visible, frame, start, end, MORE_STEPS)
        hits = int((met == number).sum())
        if 0 < hits < LEAST_HITS:
            return None
        part = float(hits / len(met) * np.prod(end - start))
        light += part * np.array(scene.emission_of(scene.visible[number]))
        share += part
    return (light, share) if 0 < share < 1 else None


def _is_clear(scene: Scene, shape: Shape, is_lamp: bool) -> bool:
    """Whether a shape that rays meet is known or dark: a matte surface, or a plain lamp."""
    return (
        _is_plain(scene, shape) if is_lamp else isinstance(scene.materials[shape.material], PLAIN)
    )


def _met(shapes: tuple[Shape, ...], frame: _Frame, start: Array, end: Array, steps: int) -> Indices:
    """Numbers of the shapes that rays through a part of the frame meet; -1 for none."""
    origin, direction = _rays(frame, start, end, steps)
    nearest, number = np.full(len(direction), math.inf), np.full(len(direction), -1)
    with np.errstate(all="ignore"):  # a plane parallel to the ray is infinitely far
        for index, shape in enumerate(shapes):
            distance = type(shape).distances(np.array([shape.row]), origin, direction)
            is_nearer = distance < nearest
            nearest, number = (
                np.where(is_nearer, distance, nearest),
                np.where(is_nearer, index, number),
            )
    return number


def _rays(frame: _Frame, start: Array, end: Array, steps: int) -> tuple[Array, Array]:
    """Origins and unit directions, (steps^2, 3) each: evenly on the film, at random on the lens."""
    random = np.random.default_rng(0)
    places = (np.arange(steps) + 0.5) / steps
    grid = np.stack(np.meshgrid(places, places), axis=-1).reshape(-1, 2)
    grid += (random.random(grid.shape) - 0.5) / steps
    slopes = ((start + grid * (end - start)) / frame.size * 2 - 1) * [1, -1] * frame.tangents
    radius, angle = np.sqrt(random.random(len(grid))), 2 * math.pi * random.random(len(grid))
    lens = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    local = np.concatenate([slopes - frame.tan_lens * lens, np.ones((len(grid), 1))], axis=1)
    direction = local @ frame.axes
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    return frame.position + frame.lens_radius * lens @ frame.axes[:2], direction
