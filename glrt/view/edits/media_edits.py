"""Edits of the media in a scene: a scene in, the edited one out.

They raise `UsageError` where the result would not be a valid scene.
"""

import math
from typing import Any

from glrt.scene.materials.nothing import Nothing
from glrt.scene.medium import Medium
from glrt.scene.scene import Scene
from glrt.view.controls import replaced
from glrt.view.edits.scene_edits import free_name, with_object

FOG = "fog"
BOUNDS = "none"  # the material of an object that only bounds a medium
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


def with_medium(scene: Scene, name: str, **changes: Any) -> Scene:
    """Return the scene with other values of a medium."""
    medium = replaced(scene.media[name], **changes)
    return replaced(scene, media={**scene.media, name: medium})
