"""Light that facets of rough glass lose to each other: their directional albedo, by quadrature.

The model scatters light once, and loses light that then meets another facet. The kernel sends it
back (shaders_glsl/bsdfs/rough_dielectric.glsl), and needs to know how much that is.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray[Any, np.dtype[np.float64]]

STEPS = 64  # of the root of the cosine, between albedos: ALBEDO_STEPS in the kernel
LEAST_LOSS = 1e-4  # share of even light: smaller losses are ignored
LATTICE = 4181, 2584  # points and steps of a lattice by neighbours in Fibonacci's sequence
EVEN_COSINES = np.sqrt((np.arange(100_000) + 0.5) / 100_000)  # of light from everywhere


class FacetLoss(NamedTuple):
    """Losses of light from outside, and from inside."""

    albedos: tuple[Array, Array]  # at STEPS + 1 even steps of the root of the cosine
    means: tuple[float, float]  # share of even light that is lost
    crossing: tuple[float, float]  # share of the lost light that goes to the other side


@lru_cache(maxsize=64)
def facet_loss(alpha: float, ior: float) -> FacetLoss | None:
    """Return the losses of GGX facets between air and glass; None below LEAST_LOSS."""
    albedos = _albedo(alpha, 1 / ior), _albedo(alpha, ior)
    means = mean_loss(albedos[0]), mean_loss(albedos[1])
    if max(means) < LEAST_LOSS:
        return None
    return FacetLoss(albedos, means, _crossing(ior, *means))


@lru_cache(maxsize=64)
def pane_loss(alpha: float, ior: float) -> FacetLoss | None:
    """Return the losses of a rough pane, whose facets are panes; None below LEAST_LOSS.

    Both sides lose the same, as much as facets that reflect all light.
    """
    albedo = _mirrored_albedo(alpha)
    if (mean := mean_loss(albedo)) < LEAST_LOSS:
        return None
    face = _fresnel(EVEN_COSINES, 1 / ior)
    crossing = 1 - float((2 * face / (1 + face)).mean())
    return FacetLoss((albedo, albedo), (mean, mean), (crossing, crossing))


def _crossing(ior: float, outer: float, inner: float) -> tuple[float, float]:
    """Return the share of lost light that crosses to the other side, from outside and from inside.

    Lost light divides as even light does at smooth glass, less on the side that loses more, so that
    the BSDF is reciprocal: n^2 times `crossing` times mean loss must be equal on both sides. The
    shares of even light that cross fulfil this if both sides lose the same.
    """
    even = 1 - _even_reflectance(1 / ior)
    return even * min(1, inner / outer), even / ior**2 * min(1, outer / inner)


def _even_reflectance(eta: float) -> float:
    """Return the Fresnel reflectance of light that is equally bright everywhere (midpoint rule)."""
    return float(_fresnel(EVEN_COSINES, eta).mean())


def mean_loss(albedo: Array) -> float:
    """Return the integral of 2 (1 - albedo) c over the cosine c, the loss of even light.

    In the root s of the cosine, it is the integral of 4 (1 - albedo) s^3. The albedo is linear in s
    between its values, as in the kernel.
    """
    root = np.linspace(0, 1, STEPS + 1)
    low, high = root[:-1], root[1:]
    all_, first = high**4 - low**4, (high**5 - low**5) * 4 / 5
    of_high = (first - low * all_) * STEPS
    lost = 1 - albedo
    return float(lost[1:] @ of_high + lost[:-1] @ (all_ - of_high))


def _albedo(alpha: float, eta: float) -> Array:
    """Return the albedo at even steps of the root of the cosine, (STEPS + 1,).

    It is the mean weight of samples by visible normals.
    """
    wo, normal, along = _seen_facets(alpha)
    reflectance = _fresnel(along, eta)
    cos_t = np.sqrt(np.maximum(1 - eta**2 * (1 - along**2), 0))
    mirrored = 2 * along * normal - wo
    refracted = (eta * along - cos_t) * normal - eta * wo
    share = [
        part[..., 0] * (sign * wi[..., 2] > 0) * weight(alpha, wo[..., 2], np.abs(wi[..., 2]))
        for part, sign, wi in ((reflectance, 1, mirrored), (1 - reflectance, -1, refracted))
    ]
    return np.asarray((share[0] + share[1]).mean(axis=1).clip(0, 1))


def _mirrored_albedo(alpha: float) -> Array:
    """Return the albedo of facets that reflect all light, as `_albedo` does."""
    wo, normal, along = _seen_facets(alpha)
    up = (2 * along * normal - wo)[..., 2]
    share = (up > 0) * weight(alpha, wo[..., 2], np.abs(up))
    return np.asarray(share.mean(axis=1).clip(0, 1))


def _seen_facets(alpha: float) -> tuple[Array, Array, Array]:
    """Return directions at even steps of the root of the cosine, and the facets seen from there.

    The arrays hold directions, normals of facets, and the cosines between them.
    """
    cosine = np.maximum(np.linspace(0, 1, STEPS + 1) ** 2, 1e-9)[:, None]
    wo = np.stack([np.sqrt(1 - cosine**2), 0 * cosine, cosine], axis=-1)
    normal = visible_normals(alpha, wo)
    return wo, normal, np.sum(wo * normal, axis=-1, keepdims=True)


def visible_normals(alpha: float, wo: Array, lattice: tuple[int, int] = LATTICE) -> Array:
    """Return normals visible from wo, (n, 1, 3), whose y is 0: the half with y above 0.

    They are (n, points, 3), where `lattice` gives points and steps. Dupuy and Benyoub, "Sampling
    Visible GGX Normals with Spherical Caps", 2023.
    """
    count, step = lattice
    points = np.arange(count)
    u = (points * step % count + 0.5).reshape(1, -1, 1) / count / 2
    v = (points + 0.5).reshape(1, -1, 1) / count
    stretched = wo * [alpha, alpha, 1]
    stretched /= np.linalg.norm(stretched, axis=-1, keepdims=True)
    z = (1 - v) * (1 + stretched[..., 2:]) - stretched[..., 2:]
    r, phi = np.sqrt(np.maximum(1 - z * z, 0)), 2 * np.pi * u
    cap = np.concatenate([r * np.cos(phi), r * np.sin(phi), z], axis=-1) + stretched
    normal = cap * [alpha, alpha, 1]
    return np.asarray(normal / np.linalg.norm(normal, axis=-1, keepdims=True))


def weight(alpha: float, cos_o: Array, cos_i: Array) -> Array:
    """Return G2 / G1(wo), with G2 = 1 / (1 + L(wo) + L(wi))."""
    mask_o, mask_i = (
        np.sqrt(1 + alpha**2 * (1 - c**2) / np.maximum(c, 1e-300) ** 2) for c in (cos_o, cos_i)
    )
    return np.asarray((1 + mask_o) / (mask_o + mask_i))


def _fresnel(cosine: Array, eta: float) -> Array:
    """Return the reflectance of unpolarised light; `eta`: index of refraction here over there."""
    cos_t = np.sqrt(np.maximum(1 - eta**2 * (1 - cosine**2), 0))
    rs = (eta * cosine - cos_t) / (eta * cosine + cos_t)
    rp = (cosine - eta * cos_t) / (cosine + eta * cos_t)
    return np.asarray((rs**2 + rp**2) / 2)
