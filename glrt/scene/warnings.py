"""Warnings about scenes that exceed float32 or the model: rendered, but not to be trusted.

docs/explanation/correctness.md says how far each limit was measured.
"""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from glrt.core.text import number, quoted
from glrt.scene.coincidence import coincidence_of
from glrt.scene.crossing_glass import MOST_COMPARED, Relation, relations
from glrt.scene.file_warnings import large_images, repeated, rounded_glass, unread
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import glass_of
from glrt.scene.scene import Scene
from glrt.scene.shapes.kinds import Shape
from glrt.scene.shapes.mesh import Mesh
from glrt.scene.shapes.plane import Plane
from glrt.scene.shapes.sphere import Sphere
from glrt.scene.summary import few
from glrt.scene.twins import twins
from glrt.scene.volumes import has_ranks, idle_priorities
from glrt.settings import Settings

ROUNDING = 2.0**-24  # relative rounding error of a float32
HUGE = 1e4  # radius of a ball over the camera's height above it, or over a touching ball's radius
LIKELY_IOR = 1.7  # below the index of gems: usual for liquids and glass against air
DENSE_IOR = 1.9  # above the index of nearly all glass
FINEST_PIXEL = 4 * ROUNDING  # radians: directions are known to one or two roundings

Floats = NDArray[np.float64]


def cautions(scene: Scene, settings: Settings) -> list[str]:
    """Return a paragraph for each limit overstepped: where, by how much, and what to do."""
    found = (
        _narrow_pixels(scene, settings),
        _huge_ball(scene),
        *_glass(scene),
        *rounded_glass(scene),
        _idle_priorities(scene),
        _walled_in(scene),
        _dark(scene),
        _endless(scene),
        _twins(scene),
        _shared_places(scene),
        _idle_shutter(scene),
        *repeated(scene),
        *unread(scene),
        large_images(scene),
    )
    return [text for text in found if text]


def _narrow_pixels(scene: Scene, settings: Settings) -> str:
    angle = 2 * math.tan(math.radians(scene.camera.fov) / 2) / settings.height
    if angle >= FINEST_PIXEL:
        return ""
    return (
        f"camera.fov {number(scene.camera.fov)} at {settings.height} rows makes pixels of "
        f"{angle:.1g} radians, finer than float32 resolves directions ({FINEST_PIXEL:.1g}): "
        "neighbouring pixels may be equal. Use fewer rows, or move the camera closer."
    )


def _huge_ball(scene: Scene) -> str:
    """Warn of a ball with a coarse surface: it has the rounding error of the ball's radius."""
    balls = _balls(scene)
    ratio, worst = max(_size_ratios(scene, balls), default=(0.0, 0))
    if ratio <= HUGE:
        return ""
    share = float(f"{100 * ratio * ROUNDING:.1g}")
    return (
        f"{_name(scene, balls[worst])}: its radius is {ratio:.1g} times the distance of the camera "
        "from its surface, or the radius of a ball that touches it; float32 resolves the surface "
        f"to {share:g} % of that at best. Use a plane or a smaller ball."
    )


def _size_ratios(scene: Scene, balls: list[int]) -> Iterator[tuple[float, int]]:
    """Yield the radius of large balls over the least length near their surface, and their number.

    That length is the camera's distance from the surface, or the radius of a ball that touches it.
    Balls are left out that are not HUGE next to the smallest ball and not seen from near.
    """
    center, radius = _places(scene, balls)
    heights = np.abs(np.linalg.norm(center, axis=1) - radius)
    largest = np.argsort(-radius)[:MOST_COMPARED]
    least = np.minimum(heights, radius.min(initial=math.inf))
    for ball in largest[radius[largest] > HUGE * least[largest]]:
        gap = np.abs(np.linalg.norm(center - center[ball], axis=1) - radius[ball])
        touching = radius[(gap <= 2 * radius) & (np.arange(len(radius)) != ball)]
        nearest = float(min([heights[ball], *touching]))
        yield float(radius[ball]) / max(nearest, float(radius[ball]) * ROUNDING), int(ball)


def _glass(scene: Scene) -> list[str]:
    """Return a warning for each relation between solids of glass that is seldom meant."""
    if has_ranks(scene):
        return []  # what is not meant there is refused
    glass = [
        i
        for i, thing in enumerate(scene.objects)
        if _is_solid_glass(scene, thing) and not isinstance(thing, Mesh) and not thing.hidden
    ]
    eye = np.array(scene.camera.position, np.float64)
    texts: dict[str, str] = {}
    for relation, (first, second) in relations([scene.objects[i] for i in glass], eye):
        ordered = all(_glass_of(scene, glass[k]).priority is not None for k in (first, second))
        if not texts.get(relation) and not ordered:
            texts[relation] = _glass_to_glass(scene, relation, glass[first], glass[second])
    return list(texts.values())


def _glass_to_glass(scene: Scene, relation: Relation, first: int, second: int) -> str:
    if relation == "inside":
        return _dense_inside(scene, first, second)
    names = " and ".join(_name(scene, index) for index in sorted((first, second)))
    if relation == "share a face":
        return (
            f"{names} are glass and share a part of a flat face: a ray meets only one of the two "
            "there, so light is refracted wrongly. Leave a hair between them, such as a thousandth "
            "of their size."
        )
    return (
        f"{names} are glass and cross: light that leaves one inside the other is refracted as if "
        "it entered air. Separate them, put one inside the other, a hair apart, or give both a "
        "priority."
    )


def _dense_inside(scene: Scene, inner: int, outer: int) -> str:
    """Warn if `ior` seems to be given against air, and not against the glass around."""
    own, around = (_glass_of(scene, index).ior for index in (inner, outer))
    if not 1 < own < LIKELY_IOR or own * around < DENSE_IOR:
        return ""
    return (
        f"{_name(scene, inner)} lies inside {_name(scene, outer)}: ior is that of an inside over "
        f"that of the glass around it, so its {number(own)} is {own * around:.3g} against air. If "
        f"{number(own)} is meant against air, write {number(own)} / {number(around)} = "
        f"{own / around:.3g}."
    )


def _is_solid_glass(scene: Scene, thing: Shape) -> bool:
    glass = glass_of(scene.materials[thing.material])
    return glass is not None and not glass.thin


def _glass_of(scene: Scene, index: int) -> Dielectric:
    glass = glass_of(scene.materials[scene.objects[index].material])
    assert glass
    return glass


def _idle_priorities(scene: Scene) -> str:
    """Warn of priorities of objects that change nothing."""
    idle = idle_priorities(scene)
    if not idle:
        return ""
    names = few(f"{_name(scene, index)}" for index in idle)
    if has_ranks(scene):
        return (
            f"{names}: `priority` changes nothing where no other volume overlaps. Leave it out, or "
            "let the objects overlap."
        )
    return (
        f"{names}: `priority` of objects counts in scenes with media alone, and this one uses "
        "none. Give the materials of glass a priority in place of it, or leave it out."
    )


def _walled_in(scene: Scene) -> str:
    """Warn of a camera inside a ball that is not glass, unless a lamp may be inside as well."""
    walls = [i for i in _balls(scene) if _kind(scene, i) != "dielectric"]
    center, radius = _places(scene, walls)
    around = np.flatnonzero(np.linalg.norm(center, axis=1) < radius)
    lamps = [thing for thing in scene.visible if any(scene.emission_of(thing))]
    for index in [walls[i] for i in around]:
        ball = scene.objects[index]
        assert isinstance(ball, Sphere)
        if not any(_reaches_into(ball, lamp) for lamp in lamps):
            return (
                f"{_name(scene, index)}: the camera is inside this ball, which "
                "is not glass and has no lamp inside: nothing outside is visible, and paths find "
                "no light. Move the camera out, or put a lamp inside."
            )
    return ""


def is_dark(scene: Scene) -> bool:
    """Return whether nothing emits, so that the picture is certain to be black."""
    emits = any(any(scene.emission(finish)) for finish in scene.finishes)
    glows = any(any(map(any, scene.emissions_of_medium(name))) for name in scene.media_in_use)
    return not (emits or glows or any(map(any, (scene.sun_radiance, *scene.background_colors))))


def _dark(scene: Scene) -> str:
    if not is_dark(scene):
        return ""
    lamps = any(finish.group for finish in scene.finishes)
    remedy = (
        "Raise the emission of a lamp, or the intensity of its group under [lights] or with --light"
        if lamps
        else 'Give an object a material of type "light", or add a [background] with a color'
    )
    return (
        "there is no light in this scene: no lamp emits and the background is black, so the "
        f"picture is black, with an estimated error of 0 %. {remedy}."
    )


def _endless(scene: Scene) -> str:
    """Warn of a medium without an end, which hides what is infinitely far away."""
    medium = scene.media.get(scene.medium or "")
    sky = ["background"] if any(map(any, scene.background.gradient)) else []
    skies = [*sky, *(["sun"] if scene.sun else [])]
    if medium is None or not any(medium.extinction) or not skies:
        return ""
    return (
        f"medium {quoted(scene.medium or '')} is everywhere, so no light comes from infinitely far "
        f"away: {' and '.join(skies)} cannot be seen. Put it into an object around the scene."
    )


def _twins(scene: Scene) -> str:
    """Warn of objects that are left out, since another one has their place."""
    pairs = [(twin.unseen, twin.seen) for twin in twins(scene.objects, scene.materials)]
    if not pairs:
        return ""
    left_out = few(f"{_name(scene, a)} (in the place of {_name(scene, b)})" for a, b in pairs)
    return (
        f"{left_out}: an object of the same geometry covers {'it' if len(pairs) == 1 else 'each'} "
        "from both sides, so it is left out and emits nothing. Delete one of each pair, or move it."
    )


def _shared_places(scene: Scene) -> str:
    """Warn of flat lamps, and bounds of volumes, that overlap other surfaces in one plane."""
    pairs = coincidence_of(scene).pairs
    if not pairs:
        return ""
    overlaps = few(
        f"{_name(scene, a)} overlaps {_name(scene, b) if a != b else 'itself'}" for a, b in pairs
    )
    return (
        f"{overlaps} in one plane, up to the rounding of surfaces of their size, and one of them "
        "emits or is no surface. A place shows one surface there: the one that emits towards the "
        "ray, or else the one of the lower number. "
        "The scene renders faster if you move one of them by a thousandth of its size."
    )


def _idle_shutter(scene: Scene) -> str:
    """Warn of an open shutter in front of a scene that stands still."""
    if not scene.camera.shutter or scene.is_blurred:
        return ""
    return (
        f"camera.shutter {number(scene.camera.shutter)} blurs nothing: the scene has no "
        "[animation] with tracks. Give it some, or leave the shutter out."
    )


def _reaches_into(ball: Sphere, lamp: Shape) -> bool:
    """Return whether some of a lamp's surface may lie in a ball, or on it."""
    middle = np.array(ball.center)
    if isinstance(lamp, Plane):
        normal = np.array(lamp.normal) / np.linalg.norm(lamp.normal)
        return bool(abs((middle - lamp.point) @ normal) < ball.radius)
    apart = float(np.linalg.norm(np.subtract(lamp.middle, middle)))
    if isinstance(lamp, Sphere):
        return abs(apart - lamp.radius) <= ball.radius
    return apart < ball.radius + lamp.reach


def _balls(scene: Scene) -> list[int]:
    things = enumerate(scene.objects)
    return [index for index, thing in things if isinstance(thing, Sphere) and not thing.hidden]


def _places(scene: Scene, balls: list[int]) -> tuple[Floats, Floats]:
    """Return centres relative to the camera, (n, 3), and radii, (n,)."""
    found = [thing for i in balls if isinstance(thing := scene.objects[i], Sphere)]
    eye = np.array(scene.camera.position, np.float64)
    center = np.array([ball.center for ball in found], np.float64).reshape(-1, 3) - eye
    return center, np.array([ball.radius for ball in found], np.float64)


def _kind(scene: Scene, index: int) -> str:
    return scene.materials[scene.objects[index].material].type


def _name(scene: Scene, index: int) -> str:
    name = scene.objects[index].name
    return f"objects[{index}]" + (f" {quoted(name)}" if name else "")
