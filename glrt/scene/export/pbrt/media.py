"""Media in the words of pbrt: what lies inside and outside each surface that bounds one."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from glrt.core.text import quoted
from glrt.scene.export.left_out import Report
from glrt.scene.export.pbrt.text import directive, with_parameters
from glrt.scene.export.tints import VACUUM, Inside, around_camera, sides_of, tinted
from glrt.scene.scene import Scene

_NONE = (0.0, 0.0, 0.0)


class Media:
    """The media of a file, each once."""

    def __init__(self, scene: Scene, report: Report) -> None:
        """`report` takes each thing that pbrt does not show."""
        self.lines = list[str]()
        self._scene, self._report = scene, report
        self._sides, self._names = sides_of(scene, report), dict[Inside, str]()
        used = [around_camera(scene), *(it for pair in self._sides.values() for it in pair)]
        for inside in dict.fromkeys(used):
            self._names[inside] = self._name(inside)

    @property
    def are_there(self) -> bool:
        """Whether light is followed through media."""
        return bool(self.lines)

    def around_camera(self) -> list[str]:
        """Return the directive for the medium around the camera; empty for vacuum."""
        name = self._names[around_camera(self._scene)]
        return [directive("MediumInterface", "", name)] if name else []

    def reset(self) -> list[str]:
        """Return the directive without which shapes would have what surrounds the camera."""
        return [directive("MediumInterface", "", "")] if self.around_camera() else []

    def bounded_by(self, number: int) -> list[str]:
        """Return the directive for the media on both sides of an object; empty for vacuum."""
        if number not in self._sides:
            return []
        inside, outside = (self._names[it] for it in self._sides[number])
        return [directive("MediumInterface", inside, outside)] if inside or outside else []

    def _name(self, inside: Inside) -> str:
        """Define a medium; return its name, which is empty for vacuum."""
        if inside == VACUUM:
            return ""
        if inside.glass:
            glass = tinted(self._scene, inside.glass)
            absorbed = glass.absorption if glass else _NONE
            tint = {"rgb sigma_a": absorbed, "rgb sigma_s": _NONE}
            return self._defined(f"{inside.glass} (tint)", tint)
        name = inside.medium or ""
        medium = self._scene.media[name]
        if medium.density is not None:
            self._report(f"the grid of {quoted(name)}, whose object is left empty")
            return ""
        absorption = np.array(medium.absorption)
        words: dict[str, Any] = {
            "rgb sigma_a": absorption,
            "rgb sigma_s": medium.scattering,
            "float g": medium.anisotropy,
        }
        emission = np.array(medium.emission)
        if emission.any():
            if (emission[absorption == 0] > 0).any():
                self._report(f"the glow of {quoted(name)} in channels without absorption")
            none = np.zeros(3)
            words["rgb Le"] = np.divide(emission, absorption, out=none, where=absorption > 0)
        return self._defined(name, words)

    def _defined(self, name: str, words: Mapping[str, Any]) -> str:
        start = directive("MakeNamedMedium", name)
        self.lines.append(with_parameters(start, {"string type": "homogeneous", **words}))
        return name
