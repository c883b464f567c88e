"""Objects in the order in which they are tried: those first that show least."""

import math

import numpy as np

from glrt.analysis.simplification.parts import Part, is_lamp, objects_of
from glrt.gpu.context import Context
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for

UNSEEN = 0.01  # weight of the solid angle of an object, which may show in mirrors and by its shadow


def by_show(scene: Scene, settings: Settings, context: Context) -> tuple[list[Part], list[Part]]:
    """Return lamps and other objects, each in rising order of what they show.

    A lamp shows its power, another object its pixels, and a little of its size about the camera.
    """
    seen = _pixels(scene, settings, context)
    parts = objects_of(scene)
    shown = {part: _power(scene, n) if is_lamp(scene, n) else _share(scene, n, seen[n])
             for n, part in enumerate(parts)}  # fmt: skip
    lamps = [part for n, part in enumerate(parts) if is_lamp(scene, n)]
    others = [part for part in parts if part not in lamps]
    return sorted(lamps, key=shown.__getitem__), sorted(others, key=shown.__getitem__)


def _pixels(scene: Scene, settings: Settings, context: Context) -> list[float]:
    """Return the share of pixels whose centre shows each object."""
    wanted = settings_for(settings, aov=("object",))
    renderer = Renderer(scene, wanted, context)
    try:
        found = renderer.render(1).image().aovs["object"].value
    finally:
        renderer.release()
    counts = np.bincount(found.ravel(), minlength=len(scene.objects) + 1)[1:] / found.size
    return [float(share) for share in counts]


def _share(scene: Scene, number: int, seen: float) -> float:
    thing = scene.objects[number]
    if thing.hidden:
        return 0.0
    if not thing.is_bounded:
        return seen + UNSEEN
    away = math.dist(thing.middle, scene.camera.position)
    return seen + UNSEEN * min(1.0, (thing.reach / max(away, 1e-30)) ** 2)


def _power(scene: Scene, number: int) -> float:
    thing = scene.objects[number]
    return 0.0 if thing.hidden else max(scene.emission_of(thing)) * thing.reach**2
