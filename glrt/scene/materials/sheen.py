"""Light that the sheen of cloth reflects, by quadrature.

shaders_glsl/bsdfs/sheen.glsl evaluates the lobe and looks the albedos up.
"""

from functools import lru_cache
from typing import Any

import numpy as np

from glrt.scene.materials.facets import STEPS

Array = np.ndarray[Any, np.dtype[np.float64]]

LEAST_ALPHA = 0.01  # a narrower lobe is one of grazing angles alone
_POINTS = 128  # of the rule of Gauss and Legendre over the root of the cosine of light
_TURNS = 96  # directions of light around the normal, over half of a turn


def sheen_alpha(roughness: float) -> float:
    """Return the alpha of a roughness, its square, as in KHR_materials_sheen of glTF."""
    return max(roughness**2, LEAST_ALPHA)


@lru_cache(maxsize=32)
def sheen_albedos(alpha: float) -> tuple[Array, Array]:
    """Return the albedo of white sheen, and of sheen that is held back: (STEPS + 1,) each.

    They stand at even steps of the root of the cosine. The lobe is divided by the larger albedo of
    both directions where that is above 1, so the second is at most 1.
    """
    places = np.linspace(0, 1, STEPS + 1)
    nodes, weights = np.polynomial.legendre.leggauss(_POINTS)
    root, weights = (nodes + 1) / 2, weights / 2
    turn = (np.arange(_TURNS) + 0.5) / _TURNS * np.pi
    even = weights * 4 * np.pi * root / _TURNS  # dz = 2 root d(root), both halves of the turn
    cosines = np.maximum(places**2, 1e-6)
    lobes = np.array([_lobe(alpha, cosine, root**2, turn).sum(axis=1) * even for cosine in cosines])
    whole = lobes.sum(axis=1)
    light = np.interp(root, places, whole)
    held = (lobes / np.maximum(np.maximum(whole[:, None], light), 1)).sum(axis=1)
    return whole, np.minimum(held, 1)


def _lobe(alpha: float, cosine: float, z: Array, turn: Array) -> Array:
    """Return the lobe times the cosine of light, (points, turns)."""
    wo = np.array([np.sqrt(1 - cosine**2), 0.0, cosine])
    r = np.sqrt(1 - z**2)[:, None]
    half = np.stack([r * np.cos(turn), r * np.sin(turn), z[:, None] + 0 * turn], axis=-1) + wo
    sine2 = (half[..., 0] ** 2 + half[..., 1] ** 2) / (half**2).sum(axis=-1)
    spread = (2 + 1 / alpha) / (2 * np.pi) * sine2 ** (0.5 / alpha)
    return np.asarray(spread * (z / (4 * (cosine + z - cosine * z)))[:, None])
