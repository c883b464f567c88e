"""Images on surfaces in the words of pbrt."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from glrt.core.text import quoted
from glrt.scene.export.companions import Companions, exact_png, pfm_of
from glrt.scene.export.left_out import Report
from glrt.scene.export.mitsuba.textures import CHANNELS
from glrt.scene.export.pbrt.text import directive, with_parameters
from glrt.scene.materials.textures import Texture
from glrt.scene.values import Radiance

Floats = NDArray[np.float64]
_FILTERS = {"linear": "bilinear", "nearest": "point"}


class Textures:
    """The textures of a file, each once."""

    def __init__(self, companions: Companions) -> None:
        """`companions` receives images."""
        self.lines = list[str]()
        self._companions, self._known = companions, dict[str, str]()

    def painted(self, texture: Texture, factor: Radiance) -> str:
        """Return the name of a texture of colours times a factor."""
        pixels = texture.texels[..., :3].astype(np.float32) * np.array(factor, np.float32)
        codes = exact_png(pixels)
        content, suffix = (codes, ".png") if codes else (pfm_of(pixels), ".pfm")
        return self._named("spectrum", texture, self._companions.add("image", suffix, content))

    def measured(self, texture: Texture, factor: float, cutoff: float | None = None) -> str:
        """Return the name of a texture of numbers times a factor; with a cutoff, of 0 and 1."""
        values = texture.texels[..., CHANNELS[texture.channel]].astype(np.float32)
        values = values * np.float32(factor)
        if cutoff is not None:
            values = (values >= cutoff).astype(np.float32)
        path = self._companions.add("image", ".pfm", pfm_of(values[..., None]))
        return self._named("float", texture, path)

    def squared(self, texture: Texture, factor: float) -> str:
        """Return the name of a texture of squares of numbers times a factor."""
        values = texture.texels[..., CHANNELS[texture.channel]].astype(np.float32)
        content = pfm_of(np.square(values * np.float32(factor))[..., None])
        return self._named("float", texture, self._companions.add("image", ".pfm", content))

    def _named(self, kind: str, texture: Texture, path: str) -> str:
        is_sharp = texture.checker is not None
        parameters = {
            "string filename": path,
            "string filter": "point" if is_sharp else _FILTERS[texture.filter],
            "string wrap": "clamp" if texture.wrap[0] == "clamp" else "repeat",
        }
        key = with_parameters(kind, parameters)
        if key not in self._known:
            name = self._known[key] = f"image {len(self._known)}"
            self.lines.append(
                with_parameters(directive("Texture", name, kind, "imagemap"), parameters)
            )
        return self._known[key]


def report_lying(name: str, textures: Mapping[str, Texture], report: Report) -> None:
    """Report how images of a material lie in ways that pbrt does not know."""
    for key, texture in textures.items():
        if texture.wrap[0] != texture.wrap[1] or "mirror" in texture.wrap:
            report(f"what lies beyond the image of {key} of {quoted(name)}")
    if len({texture.transform.tobytes() for texture in textures.values()}) > 1:
        report(f"images of {quoted(name)} that lie in different ways")
    if len({texture.uv for texture in textures.values()}) > 1:
        report(f"the second set of coordinates of {quoted(name)}")


def lying(uv: Floats, textures: Mapping[str, Texture]) -> Floats:
    """Return coordinates, (v, 2), of pbrt, which grow upwards, as the first texture takes them."""
    first = next(iter(textures.values()), None)
    if first is not None:
        uv = uv @ first.transform[:, :2].T + first.transform[:, 2]
    return uv * [1.0, -1.0] + [0.0, 1.0]
