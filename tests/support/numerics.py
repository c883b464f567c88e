"""Inputs of the tests of shader functions, and the units that they measure in."""

from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]

ULP = 2.0**-23
BELOW_ONE = 1 - 2.0**-24  # the largest number drawn


def unit_square(side: int = 512) -> Array:
    """Midpoints of side x side cells, (n, 2)."""
    middles = (np.arange(side) + 0.5) / side
    return np.stack(np.meshgrid(middles, middles), axis=-1).reshape(-1, 2)


def corners() -> Array:
    """The extremes that can be drawn, (n, 2)."""
    ends = [0.0, 2.0**-24, 0.5, BELOW_ONE]
    return np.array([(x, y) for x in ends for y in ends])


def directions(count: int, seed: int = 1) -> Array:
    """Unit vectors all around, (n, 3) float32: random, along axes, and close to the poles."""
    random = np.random.default_rng(seed).normal(size=(count, 3))
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    tilts = 10.0 ** -np.arange(1, 20)
    poles = [
        (s * t, c * t, z) for t in tilts for s in (1, -1, 0) for c in (1, 0.5) for z in (1, -1)
    ]
    equator = [(np.cos(a), np.sin(a), z) for a in range(6) for z in (1e-9, -1e-9, 0.0, -0.0)]
    found = np.concatenate([random, axes, np.array(poles), np.array(equator)])
    units: Array = found / np.linalg.norm(found, axis=1, keepdims=True)
    return units.astype(np.float32)


def length(v: Array) -> Array:
    norms: Array = np.linalg.norm(v.astype(np.float64), axis=-1)
    return norms


def wo_at(cosine: Array | float) -> Array:
    """Unit vectors at this cosine to the normal, (n, 3)."""
    z = np.atleast_1d(np.asarray(cosine, np.float64))
    return np.stack([-np.sqrt(1 - z * z), 0 * z, z], axis=-1)


def float32(values: Any) -> Array:
    """The float64 values of what the shader is given."""
    given: Array = np.asarray(values, np.float32)
    return given.astype(np.float64)


def dot(a: Array, b: Array) -> Array:
    product: Array = (a * b).sum(axis=-1)
    return product


def roots64(center: Array, radius: Array, origin: Array, direction: Array) -> tuple[Array, Array]:
    """Both distances to a sphere, NaN for a miss, and how far the ray passes from its centre."""
    norm = np.linalg.norm(direction, axis=-1)
    unit = direction / norm[..., None]
    to_center = center - origin
    along = dot(to_center, unit)
    beside = np.linalg.norm(to_center - along[..., None] * unit, axis=-1)
    with np.errstate(invalid="ignore"):
        half = np.sqrt((radius - beside) * (radius + beside))
    return np.stack([along - half, along + half]) / norm, beside


def lattice(count: int = 128) -> Array:
    """Three numbers of a sample: a lattice of count^2 points (Korobov), (n, 3)."""
    steps = np.arange(count * count)[:, None] * np.array([1, 1487, 1487**2 % count**2])
    points: Array = ((steps % count**2) + 0.5) / count**2
    return points
