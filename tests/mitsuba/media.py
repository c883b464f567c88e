"""Media in the words of Mitsuba: what lies inside and outside each surface that bounds one."""

from typing import Any

import numpy as np

from glrt.core.errors import SceneError
from glrt.scene.scene import Scene
from glrt.scene.volumes import bounds_of, medium_around
from tests.mitsuba.near import Near

Words = dict[str, Any]


def integrator(scene: Scene) -> str:
    """The integrator that follows light through media by all channels, or the one without."""
    return "volpathmis" if scene.media_in_use else "path"


def around_camera(scene: Scene, at: Near) -> Words:
    """The medium around the camera."""
    eye = np.array(scene.camera.position, np.float64)
    name = medium_around(scene, eye) if scene.media_in_use else None
    return {} if name is None else {"medium": _medium(scene, name, at)}


def bounds(scene: Scene, at: Near) -> dict[int, Words]:
    """The media inside and outside of the surfaces of objects, by their numbers in the scene."""
    found: dict[int, Words] = {}
    for number, inside, outside in bounds_of(scene):
        sides = {"interior": inside, "exterior": outside}
        found[number] = {
            side: _medium(scene, name, at) for side, name in sides.items() if name is not None
        }
    return found


def _medium(scene: Scene, name: str, at: Near) -> Words:
    medium = scene.media[name]
    if medium.emits:
        raise SceneError(f"medium '{name}': the converter knows media that do not shine.")
    total = [max(x, 1e-12) for x in medium.extinction]
    albedo = [s / x for s, x in zip(medium.scattering, total, strict=True)]
    return {
        "type": "homogeneous",
        "sigma_t": {"type": "rgb", "value": [x / at.factor for x in total]},
        "albedo": {"type": "rgb", "value": albedo},
        "phase": {"type": "hg", "g": medium.anisotropy},
    }
