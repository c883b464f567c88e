"""Media in the words of Mitsuba: what lies inside and outside each surface that bounds one."""

import numpy as np
from numpy.typing import NDArray

from glrt.core.text import quoted
from glrt.scene.export.left_out import Report
from glrt.scene.export.mitsuba.words import COMMENT, Voxels, Words, color
from glrt.scene.export.placing import Placing
from glrt.scene.export.tints import VACUUM, Inside, around_camera, sides_of, tinted
from glrt.scene.grids import grid_of, placement_of
from glrt.scene.materials.kinds import Material
from glrt.scene.materials.nothing import Nothing
from glrt.scene.materials.principled import Principled
from glrt.scene.scene import Scene

Floats = NDArray[np.float64]

_LEAST = 1e-12  # extinction of a channel, per unit


class Media:
    """The media of a scene; equal ones are the same words."""

    def __init__(self, scene: Scene, at: Placing, report: Report) -> None:
        """`report` takes each thing that Mitsuba does not show."""
        self._scene, self._at, self._report = scene, at, report
        self._sides, self._known = sides_of(scene, report), dict[Inside, Words]()

    @property
    def integrator(self) -> str:
        """The integrator that follows light through media by all channels, or the one without.

        The first alone finds lamps through surfaces that let light pass straight.
        """
        crossed = any(_is_crossed(self._scene.materials[it.material]) for it in self._scene.visible)
        is_simple = not (self._sides or self._scene.media_in_use or crossed)
        return "path" if is_simple else "volpathmis"

    def around_camera(self) -> Words:
        """Return the medium around the camera."""
        found = self._medium(around_camera(self._scene))
        return {"medium": found} if found else {}

    def bounded_by(self, number: int) -> Words:
        """Return the media inside and outside of an object."""
        if number not in self._sides:
            return {}
        inside, outside = map(self._medium, self._sides[number])
        found = {"interior": inside, "exterior": outside}
        return {side: medium for side, medium in found.items() if medium}

    def _medium(self, inside: Inside) -> Words | None:
        if inside == VACUUM:
            return None
        if inside not in self._known:
            words = self._tint(inside.glass) if inside.glass else self._fog(inside)
            self._known[inside] = {**words, COMMENT: inside.glass or inside.medium}
        return self._known[inside]

    def _tint(self, name: str) -> Words:
        glass = tinted(self._scene, name)
        absorption = glass.absorption if glass else (0.0, 0.0, 0.0)
        return self._even(np.zeros(3), np.array(absorption), 0.0)

    def _fog(self, inside: Inside) -> Words:
        name = inside.medium or ""
        medium = self._scene.media[name]
        if medium.transfer:
            self._report(f"the transfer function of {quoted(name)}")
        elif medium.emits:
            self._report(f"the glow of {quoted(name)}")
        scattering = np.array(medium.scattering)
        if medium.density is None:
            return self._even(scattering, np.array(medium.absorption), medium.anisotropy)
        if medium.density.min is not None:
            self._report(f"the end of the grid of {quoted(name)} inside its object")
        total = np.maximum(medium.extinction, _LEAST)
        grid = self._grid(name, inside.holder, total / self._at.factor)
        how = _scattered(scattering, total, medium.anisotropy)
        return {"type": "heterogeneous", "sigma_t": grid, **how}

    def _even(self, scattering: Floats, absorption: Floats, anisotropy: float) -> Words:
        total = np.maximum(scattering + absorption, _LEAST)
        how = _scattered(scattering, total, anisotropy)
        return {"type": "homogeneous", "sigma_t": color(total / self._at.factor), **how}

    def _grid(self, name: str, holder: int | None, extinction: Floats) -> Words:
        """Return the extinction of a medium as voxels of three channels in a box."""
        grid, place = grid_of(self._scene, name), placement_of(self._scene, name, holder)
        inverse = np.linalg.inv(place.linear)
        linear = inverse * grid.voxels.shape[::-1]  # from the unit cube
        densities = grid.top * grid.voxels.astype(np.float32)
        return {
            "type": "gridvolume",
            "grid": Voxels(densities[..., None] * extinction.astype(np.float32)),
            "to_world": self._at.matrix(linear, -inverse @ place.origin),
            "filter_type": "trilinear",
            "wrap_mode": "clamp",
            "raw": True,
        }


def _scattered(scattering: Floats, total: Floats, anisotropy: float) -> Words:
    phase = {"type": "hg", "g": float(anisotropy)}
    return {"albedo": color(scattering / total), "phase": phase}


def _is_crossed(material: Material) -> bool:
    """Return whether light passes a surface straight, everywhere or in places."""
    return isinstance(material, Nothing) or (
        isinstance(material, Principled) and material.has_holes
    )
