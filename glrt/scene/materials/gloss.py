"""Light that the facets of a principled surface reflect, by quadrature.

shaders_glsl/bsdfs/principled_parts.glsl looks it up.
"""

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from glrt.scene.materials.facets import LEAST_LOSS, STEPS, mean_loss, visible_normals, weight

Array = np.ndarray[Any, np.dtype[np.float64]]


class FacetShares(NamedTuple):
    """The directional albedo of GGX facets is f0 `head_on` + f90 `grazing`: Schlick's reflectance.

    The arrays hold STEPS + 1 even steps of the root of the cosine, and the means hold for light
    that is equally bright from everywhere.
    """

    head_on: Array
    grazing: Array
    mean_head_on: float
    mean_grazing: float

    @classmethod
    def of(cls, head_on: Array, grazing: Array) -> "FacetShares":
        """Return the shares of these two arrays, with their means."""
        return cls(head_on, grazing, 1 - mean_loss(head_on), 1 - mean_loss(grazing))

    @property
    def kept(self) -> float:
        """Share of even light that white facets keep; 1 if they lose less than LEAST_LOSS."""
        kept = self.mean_head_on + self.mean_grazing
        return kept if kept < 1 - LEAST_LOSS else 1.0


@lru_cache(maxsize=128)
def facet_shares(alpha: float, stretch: float = 1.0) -> FacetShares:
    """Return the shares of facets that scatter light once.

    With a `stretch`, alpha is that many times as large along x, and the shares are means over all
    directions around the normal.
    """
    if stretch != 1:
        return _mean_around(alpha, stretch)
    root = np.linspace(0, 1, STEPS + 1)
    grazing = (1 - root**2) ** 5
    head_on = 1 - grazing
    if alpha > 0:
        head_on, grazing = _rough(alpha, np.maximum(root**2, 1e-9))
    return FacetShares.of(head_on, grazing)


ROUGHNESS_STEPS = 255  # of a textured roughness: shaders_glsl/textures/mapped.glsl
_KNOTS = (*range(32), *range(32, 64, 4), *range(64, 256, 8), 255)  # steps that are integrated


def shares_by_step() -> dict[str, Array]:
    """Return `head_on` and `grazing` at each step of roughness, (256, STEPS + 1) each.

    They are linear between knots, and differ from the integrals by 0.001 at most.
    """
    steps = np.arange(ROUGHNESS_STEPS + 1)
    knots = [facet_shares((knot / ROUGHNESS_STEPS) ** 2) for knot in _KNOTS]
    found = {}
    for name in ("head_on", "grazing"):
        rows = np.array([getattr(knot, name) for knot in knots])
        columns = [np.interp(steps, _KNOTS, column) for column in rows.T]
        found[name] = np.stack(columns, axis=1)
    return found


TURNS = 8  # steps of a quarter turn between tables: albedos_around in the kernel
_FEW = (610, 377)  # points and steps of a lattice, as in visible_normals


@lru_cache(maxsize=32)
def shares_around(alpha: float, stretch: float) -> tuple[FacetShares, ...]:
    """Return the shares of facets with `stretch` times the alpha along x, TURNS + 1 of them.

    The first is for light whose direction lies over the x axis, the last for light over the y axis.
    The steps are even in |y| / (r |x| + |y|), where r is the root of `stretch`.
    """
    cosine = np.maximum(np.linspace(0, 1, STEPS + 1) ** 2, 1e-9)
    places = np.arange(TURNS + 1) / TURNS
    angles = np.arctan2(math.sqrt(stretch) * places, 1 - places)
    return tuple(FacetShares.of(*_drawn(alpha, stretch, cosine, angle)) for angle in angles)


def _mean_around(alpha: float, stretch: float) -> FacetShares:
    """Return the mean of `shares_around` over a quarter turn; they are linear between steps."""
    weights = turn_weights(stretch)
    shares = shares_around(alpha, stretch)
    tables = ([getattr(it, name) for it in shares] for name in ("head_on", "grazing"))
    return FacetShares.of(*(weights @ np.array(table) for table in tables))


def turn_weights(stretch: float) -> Array:
    """Return the weights of `shares_around` in their mean over all directions, (TURNS + 1,)."""
    angle = (np.arange(10_000) + 0.5) / 10_000 * math.pi / 2
    place = TURNS * np.sin(angle) / (np.sin(angle) + math.sqrt(stretch) * np.cos(angle))
    return np.asarray(np.maximum(1 - np.abs(place[:, None] - np.arange(TURNS + 1)), 0).mean(axis=0))


def _drawn(alpha: float, stretch: float, cosine: Array, angle: float) -> tuple[Array, Array]:
    """Return `head_on` and `grazing` for light whose direction is turned by `angle` from x.

    Where x is stretched, facets are those of `alpha`. Visible normals are sampled there.
    """
    sine = np.sqrt(1 - cosine**2)
    wo = np.stack([sine * math.cos(angle), sine * math.sin(angle), cosine], axis=-1)[:, None]
    x, y = stretch * wo[..., 0], wo[..., 1]
    across = np.hypot(x, y)
    half = visible_normals(alpha, np.stack([across, 0 * across, wo[..., 2]], axis=-1), _FEW)
    both = np.concatenate([half, half * [1, -1, 1]], axis=1)
    turn = np.arctan2(y, x)
    normal = np.stack(
        [
            stretch * (both[..., 0] * np.cos(turn) - both[..., 1] * np.sin(turn)),
            both[..., 0] * np.sin(turn) + both[..., 1] * np.cos(turn),
            both[..., 2],
        ],
        axis=-1,
    )
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    along = np.sum(wo * normal, axis=-1, keepdims=True)
    wi = 2 * along * normal - wo
    seen, lit = (
        np.sqrt(1 + alpha**2 * ((stretch * w[..., 0]) ** 2 + w[..., 1] ** 2) / w[..., 2] ** 2)
        for w in (wo, wi)
    )
    share = (wi[..., 2] > 0) * (1 + seen) / (seen + lit)
    edge = (1 - along[..., 0]).clip(0) ** 5
    return (share * (1 - edge)).mean(axis=1), (share * edge).mean(axis=1)


def _rough(alpha: float, cosine: Array) -> tuple[Array, Array]:
    """Return `head_on` and `grazing` as the mean weights of samples by visible normals."""
    cosine = cosine[:, None]
    wo = np.stack([np.sqrt(1 - cosine**2), 0 * cosine, cosine], axis=-1)
    normal = visible_normals(alpha, wo)
    along = np.sum(wo * normal, axis=-1, keepdims=True)
    wi = 2 * along * normal - wo
    share = (wi[..., 2] > 0) * weight(alpha, wo[..., 2], np.abs(wi[..., 2]))
    edge = (1 - along[..., 0]).clip(0) ** 5
    return (share * (1 - edge)).mean(axis=1), (share * edge).mean(axis=1)
