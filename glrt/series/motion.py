"""How much of the shapes moves from frame to frame of a series, and the kernel that pays then."""

from collections.abc import Iterable
from typing import Literal

from glrt.packing.shapes import PLACES
from glrt.rendering.pipelines import Tier
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.settings import Settings

# Places move if shapes are shifted, or if the camera is: the kernel has them relative to its eye.
Motion = Literal["none", "places", "shapes"]

# Pixels times samples times shapes of a frame (docs/results/speed.md). Shorter renders use the
# kernel that reads the shapes, as other scenes may have compiled it. From MUCH on, it pays to
# compile a kernel for each frame in which shapes move; where places alone move, from FAR_MORE on.
LITTLE, MUCH, FAR_MORE = 2_000_000, 32_000_000, 1_000_000_000
_VIEW = "look_at", "up", "fov", "defocus_angle", "focus_distance"  # leave the eye where it is


def motion_of(scene: Scene, keys: Iterable[tuple[str, ...]]) -> Motion:
    """Return what moves if the values of these keys change from frame to frame."""
    kinds = {thing.name: type(thing) for thing in scene.objects if thing.name}
    found: Motion = "none"
    for key in keys:
        kind = kinds.get(key[1]) if key[0] == "objects" else None
        is_eye = key[0] == "camera" and key[1] not in _VIEW
        if is_eye or (kind and PLACES.get(kind.__name__) == key[2]):
            found = "places"
        elif key[0] == "objects" and kind is not Mesh:
            return "shapes"
    return found


def tier_of(scene: Scene, settings: Settings, motion: Motion) -> Tier:
    """Return the tier for a frame; it follows from the series alone, not from the machine."""
    width, height = settings.size
    work = width * height * settings.samples * max(1, len(scene.objects))
    if scene.is_blurred:
        return "generic"  # a shutter moves shapes between samples
    if motion == "places":
        has_meshes = any(isinstance(thing, Mesh) for thing in scene.objects)
        most = MUCH if has_meshes else FAR_MORE  # rays of meshes take longer
        return "generic" if work < LITTLE else "placed" if work < most else "baked"
    return "baked" if work >= (LITTLE if motion == "none" else MUCH) else "generic"
