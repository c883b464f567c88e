"""Thin films on facets, whose reflections interfere: KHR_materials_iridescence of glTF.

shaders_glsl/bsdfs/iridescence.glsl evaluates the same formulas.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from glrt.scene.values import Color

Array = np.ndarray[Any, np.dtype[np.float64]]

LEAST_WHOLE = 0.03  # nanometres: a thinner film fades away
MOST_EDGE = 2.5  # of bounds of the reflectance
_HEIGHTS = np.array([0.84659001, 1.00022189, 1.00112249, 0.15386831])
_CENTRES = np.array([1.6810, 1.7953, 2.2084, 2.2399])
_WIDTHS = np.array([4.3278e-3, 9.3046e-3, 6.6121e-3, 4.5282e-3])
_SRGB = np.array(  # from CIE X, Y, Z and the second part of X
    [
        [3.2404542, -1.5371385, -0.4985314, 3.2404542],
        [-0.9692660, 1.8760108, 0.0415560, -0.9692660],
        [0.0556434, -0.2040259, 1.0572252, 0.0556434],
    ]
)


class ThinFilm(NamedTuple):
    """A film of an index of refraction and a thickness in nanometres, in air."""

    ior: float
    thickness: float

    @property
    def presence(self) -> float:
        """The share of the film that is there: 0 where its thickness is 0, else nearly always 1.

        glTF lets the index fall to that of air. Schlick's reflectance of air is not 0 at the edge.
        """
        x = min(self.thickness / LEAST_WHOLE, 1.0)
        return x * x * (3 - 2 * x)

    @property
    def micrometres(self) -> float:
        """The thickness in micrometres."""
        return self.thickness / 1000

    def reflectance(self, f0: Color, cosine: Array) -> Array:
        """Return the reflectance in linear sRGB, (n, 3), on a surface that reflects `f0` head-on.

        `cosine`, (n,), is of the angle to the normal in air. The source is Belcour and Barla, "A
        Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence" (2017).
        """
        ior = self.ior
        inside = np.sqrt(1 - (1 - cosine**2) / ior**2)
        outer = _schlick(((ior - 1) / (ior + 1)) ** 2, cosine)[:, None]
        root = np.sqrt(np.clip(f0, 0, 0.9999))
        below = (1 + root) / (1 - root)
        inner = _schlick(((below - ior) / (below + ior)) ** 2, inside[:, None])
        both = np.minimum(outer * inner, 0.9999)
        even = (1 - outer) ** 2 * inner / (1 - both)
        r = np.where(below < ior, 1, -1) * np.sqrt(both)
        path = 2 * ior * self.micrometres * inside
        waves = 2 * r * (_interference(path) + r * _interference(2 * path))
        return np.asarray((outer + even + (even - 1 + outer) * waves).clip(0, 1))


@lru_cache(maxsize=128)
def reflectance_bound(film: ThinFilm, f0: Color) -> tuple[float, float]:
    """Return a and b with a (1 - s) + b s >= the reflectance of all channels at all angles.

    s = (1 - cosine)^5 is Schlick's weight, and b lies in 1 to MOST_EDGE. Among such bounds, the
    result is the one with the least mean in even light. Albedos of the bound thus need no table.
    """
    cosine = np.linspace(0, 1, 2049)[1:]
    weight = (1 - cosine) ** 5
    most = film.reflectance(f0, cosine).max(axis=1)
    edges = np.linspace(1, MOST_EDGE, 151)
    heads = ((most - edges[:, None] * weight) / (1 - weight)).max(axis=1).clip(0, 1)
    best = int(np.argmin(heads * 20 + edges))
    return float(heads[best]), float(edges[best])


def _schlick(f0: Any, cosine: Array) -> Array:
    return np.asarray(f0 + (1 - f0) * (1 - cosine) ** 5)


def _interference(path: Array) -> Array:
    """Return the transformed sensitivity of the eye in linear sRGB, (n, 3); micrometres."""
    phase = 2 * np.pi * path[:, None]
    waves = _HEIGHTS * np.cos(_CENTRES * phase) * np.exp(-_WIDTHS * phase**2)
    return np.asarray(waves @ _SRGB.T)
