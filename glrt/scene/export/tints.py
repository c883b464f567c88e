"""Media of a scene for programs that know tinted glass as a medium that absorbs."""

from typing import NamedTuple

import numpy as np

from glrt.core.text import quoted
from glrt.scene.export.left_out import Report
from glrt.scene.materials.dielectric import Dielectric
from glrt.scene.materials.kinds import glass_of
from glrt.scene.scene import Scene
from glrt.scene.volumes import (
    MOST_VOLUMES,
    bounds_a_volume,
    has_ranks,
    medium_in,
    outer_volumes,
    volume_around,
)


class Inside(NamedTuple):
    """The filling of a volume: a medium, or the tint of a glass; both None for vacuum."""

    medium: str | None = None
    glass: str | None = None  # name of its material
    holder: int | None = None  # number of the object, for a medium with a grid


VACUUM = Inside()


class Sides(NamedTuple):
    """The fillings inside and outside of an object."""

    inside: Inside
    outside: Inside


def tinted(scene: Scene, name: str) -> Dielectric | None:
    """Return the glass that a material is, if it absorbs light."""
    glass = glass_of(scene.materials[name])
    return glass if glass and not glass.thin and any(glass.absorption) else None


def sides_of(scene: Scene, report: Report) -> dict[int, Sides]:
    """Return what lies on both sides of each object that bounds a volume, by number.

    Without media and tinted glass there are none. `report` takes what cannot be known: which of
    more than MOST_VOLUMES volumes lies in which.
    """
    solids = [n for n in scene.shown if bounds_a_volume(scene.materials[scene.objects[n].material])]
    if not scene.media_in_use and not any(tinted(scene, scene.objects[n].material) for n in solids):
        return {}
    if has_ranks(scene):
        report("the priority of volumes that overlap")
    around: dict[int, list[int]] = {n: [] for n in solids}
    if len(solids) <= MOST_VOLUMES:
        around |= {n: held for n, held in outer_volumes(scene).items() if n in around}
    else:
        report("which volume lies in which other one")
    return {
        n: Sides(_filling(scene, n, report), _filling(scene, held[-1], report))
        if held
        else Sides(_filling(scene, n, report), _medium(scene, None))
        for n, held in around.items()
    }


def around_camera(scene: Scene) -> Inside:
    """Return what the camera stands in."""
    eye = np.array(scene.camera.position, np.float64)
    if scene.media_in_use and (found := _medium(scene, volume_around(scene, eye))).medium:
        return found
    holding = [it for it in scene.visible if tinted(scene, it.material) and it.holds(eye)]
    inner = min(holding, key=lambda it: it.reach, default=None)
    return Inside(None, inner.material) if inner else VACUUM


def _filling(scene: Scene, number: int, report: Report) -> Inside:
    thing = scene.objects[number]
    if not tinted(scene, thing.material):
        return _medium(scene, number)
    if thing.medium:
        report(f"the tint of {quoted(thing.material)} around {quoted(thing.medium)}")
        return _medium(scene, number)
    return Inside(None, thing.material)


def _medium(scene: Scene, number: int | None) -> Inside:
    """Return the medium in an object, or with None outside of all."""
    name = medium_in(scene, number)
    has_grid = name is not None and scene.media[name].density is not None
    return Inside(name, None, number if has_grid else None)
