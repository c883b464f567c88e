"""Media in the words of Mitsuba: what lies inside and outside each surface that bounds one."""

import importlib
from typing import Any

import numpy as np

from glrt.core.errors import SceneError
from glrt.plan.media import Filling
from glrt.scene.grids import grid_of, placement_of
from glrt.scene.scene import Scene
from glrt.scene.volumes import bounds_of, medium_in, volume_around
from tests.mitsuba.near import Near
from tests.support.numerics import Array

Words = dict[str, Any]


def integrator(scene: Scene) -> str:
    """The integrator that follows light through media by all channels, or the one without."""
    return "volpathmis" if scene.media_in_use else "path"


def around_camera(scene: Scene, at: Near) -> Words:
    """The medium around the camera."""
    eye = np.array(scene.camera.position, np.float64)
    if not scene.media_in_use:
        return {}
    number = volume_around(scene, eye)
    name = medium_in(scene, number)
    return {} if name is None else {"medium": _medium(scene, name, number, at)}


def bounds(scene: Scene, at: Near) -> dict[int, Words]:
    """The media inside and outside of the surfaces of objects, by their numbers in the scene."""
    found: dict[int, Words] = {}
    for it in bounds_of(scene):
        sides = {"interior": (it.inside, it.number), "exterior": (it.outside, it.around)}
        found[it.number] = {
            side: _medium(scene, name, holder, at)
            for side, (name, holder) in sides.items()
            if name is not None
        }
    return found


def _medium(scene: Scene, name: str, holder: int | None, at: Near) -> Words:
    medium = scene.media[name]
    if medium.emits:
        raise SceneError(f"medium '{name}': the converter knows media that do not shine.")
    total = np.maximum(medium.extinction, 1e-12)
    albedo = {"type": "rgb", "value": (np.array(medium.scattering) / total).tolist()}
    phase = {"type": "hg", "g": medium.anisotropy}
    if medium.density is not None:
        grid = _grid(scene, Filling(name, holder), total / at.factor, at)
        return {"type": "heterogeneous", "sigma_t": grid, "albedo": albedo, "phase": phase}
    even = {"type": "rgb", "value": (total / at.factor).tolist()}
    return {"type": "homogeneous", "sigma_t": even, "albedo": albedo, "phase": phase}


def _grid(scene: Scene, filling: Filling, extinction: Array, at: Near) -> Words:
    """The extinction of a medium as voxels of three channels, in a box that fills its object."""
    mi = importlib.import_module("mitsuba")
    name = filling.medium
    density = scene.media[name].density
    if density is None or density.min is not None:
        raise SceneError(f"medium '{name}': the converter knows grids that fill their object.")
    grid, place = grid_of(scene, name), placement_of(scene, *filling)
    inverse = np.linalg.inv(place.linear)
    matrix = np.eye(4)  # from the unit cube
    matrix[:3, :3] = at.along(inverse * grid.voxels.shape[::-1])
    matrix[:3, 3] = at.point(-inverse @ place.origin)
    values = grid.top * grid.voxels.astype(np.float32)[..., None] * extinction.astype(np.float32)
    return {
        "type": "gridvolume",
        "grid": mi.VolumeGrid(values),
        "to_world": mi.ScalarTransform4f(matrix),
        "filter_type": "trilinear",
        "wrap_mode": "clamp",
        "raw": True,
    }
