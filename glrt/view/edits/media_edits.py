"""Edits of the media in a scene: a scene in, the edited one out.

They raise `UsageError` where the result would not be a valid scene.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from glrt.core.errors import UsageError
from glrt.scene.materials.nothing import Nothing
from glrt.scene.medium import Medium
from glrt.scene.scene import Scene
from glrt.scene.transfer import Transfer
from glrt.scene.values import BLACK, WHITE
from glrt.view.controls import replaced
from glrt.view.edits.scene_edits import free_name, with_object

FOG = "fog"
BOUNDS = "none"  # the material of an object that only bounds a medium
KNOTS = {"value": "values", "color": "colors", "opacity": "opacities"}  # lists of each value
OPACITY = 0.9  # of what is densest in a new transfer function, over the half of its object
DEPTH = 2.0  # optical depth of new fog, from the middle of its object to its surface


def with_fog(scene: Scene, index: int) -> Scene:
    """Return the scene with white fog in place of object `index`, which stays as its bounds."""
    name, thing = free_name(FOG, scene.media), scene.objects[index]
    reach = thing.reach if math.isfinite(thing.reach) else 1.0
    density = float(f"{DEPTH / reach:.2g}")
    fog = Medium(scattering=(density, density, density))
    bounds = next((n for n, it in scene.materials.items() if isinstance(it, Nothing)), None)
    material = bounds or free_name(BOUNDS, scene.materials)
    filled = replaced(
        scene,
        media={**scene.media, name: fog},
        materials={material: Nothing(), **scene.materials},
    )
    return with_object(filled, index, replaced(thing, material=material, medium=name))


def with_medium_of(scene: Scene, index: int, name: str | None) -> Scene:
    """Return the scene with another of its media, or vacuum for None, in object `index`."""
    return with_object(scene, index, replaced(scene.objects[index], medium=name))


def with_priority(scene: Scene, index: int, priority: int | None) -> Scene:
    """Return the scene with another priority of the volume of object `index`, or None for none."""
    return with_object(scene, index, replaced(scene.objects[index], priority=priority))


def with_medium(scene: Scene, name: str, **changes: Any) -> Scene:
    """Return the scene with other values of a medium."""
    medium = replaced(scene.media[name], **changes)
    return replaced(scene, media={**scene.media, name: medium})


def with_medium_part(scene: Scene, name: str, key: str, changes: Mapping[str, Any]) -> Scene:
    """Return the scene with other values of the density or the transfer function of a medium."""
    part = replaced(getattr(scene.media[name], key), **changes)
    return with_medium(scene, name, **{key: part})


def with_transfer(scene: Scene, name: str, is_on: bool) -> Scene:
    """Return the scene with a grid shown from black to white by density, or as even smoke."""
    density = scene.media[name].density
    holder = next((it for it in scene.objects if it.medium == name), None)
    reach = holder.reach if holder and math.isfinite(holder.reach) else 1.0
    if density is None:
        raise UsageError(f"{name} has no grid whose values can be shown")
    if not is_on:
        even = DEPTH / reach / (density.scale * density.file.most or 1.0)
        medium = Medium(scattering=(even, even, even), density=density)
        return replaced(scene, media={**scene.media, name: medium})
    transfer = Transfer(
        values=(0.0, density.scale * density.file.most),
        colors=(BLACK, WHITE),
        opacities=(0.0, OPACITY),
        length=float(f"{reach:.2g}"),
    )
    medium = Medium(density=density, transfer=transfer)
    return replaced(scene, media={**scene.media, name: medium})


def knots_of(transfer: Transfer) -> Iterator[dict[str, Any]]:
    """Yield value, color and opacity of each knot."""
    for row in zip(*(getattr(transfer, many) for many in KNOTS.values()), strict=True):
        yield dict(zip(KNOTS, row, strict=True))


def with_knot(scene: Scene, name: str, number: int, **changes: Any) -> Scene:
    """Return the scene with another value, color or opacity of a knot of a medium."""
    transfer = scene.media[name].transfer
    lists = {KNOTS[key]: list(getattr(transfer, KNOTS[key])) for key in changes}
    for key, value in changes.items():
        lists[KNOTS[key]][number] = value
    assert transfer is not None
    return with_medium(scene, name, transfer=replaced(transfer, **lists))
