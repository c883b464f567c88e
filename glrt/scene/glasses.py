"""The glasses of a scene, and the glass around its camera."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from glrt.scene.lit_scene import Finish
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import glass_of
from glrt.scene.nesting import BITS
from glrt.scene.scene import Scene
from glrt.scene.values import BLACK, Color

Array = np.ndarray[Any, Any]


class Around(NamedTuple):
    """The glass around a point."""

    absorption: Color  # per unit length
    counts: int  # objects around it for each glass with a priority, packed as in the kernel


AIR = Around(BLACK, 0)


def glasses_of(scene: Scene, finishes: Iterable[Finish]) -> dict[str, Dielectric]:
    """Return the glasses of these finishes that are rough, tinted or have a priority, by name.

    Glasses with a priority come first, the highest before the others.
    """
    found: dict[str, Dielectric] = {}
    for finish in finishes:
        glass = glass_of(scene.materials[finish.material])
        if glass and glass.has_details:
            found[finish.material] = glass
    return dict(sorted(found.items(), key=lambda item: _rank(item[1])))


def _rank(glass: Dielectric) -> tuple[bool, int]:
    return glass.priority is None, -(glass.priority or 0)


def nested_of(glasses: dict[str, Dielectric]) -> list[str]:
    """Return the names of those glasses of `glasses_of` with a priority."""
    return [name for name, glass in glasses.items() if glass.priority is not None]


def around_camera(scene: Scene, glasses: dict[str, Dielectric]) -> Around:
    """Return the glass around the middle of the lens, and the counts of glasses there.

    It is the glass of the highest priority; without priorities, the glass of the smallest object.
    `glasses` are those of `glasses_of`.
    """
    if not glasses:
        return AIR
    point = np.array(scene.camera.position, np.float64)
    inside = [it for it in scene.visible if it.material in glasses and it.holds(point)]
    ranked = nested_of(glasses)
    counts = [sum(it.material == name for it in inside) for name in ranked]
    there = [name for name, count in zip(ranked, counts, strict=True) if count]
    there += [it.material for it in sorted(inside, key=lambda it: it.reach)]
    absorption = glasses[there[0]].absorption if there else BLACK
    return Around(absorption, sum(count << BITS * k for k, count in enumerate(counts)))
