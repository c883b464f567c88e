"""Moments of each film of a picture: radiance, particles and AOVs."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.image.aovs import AovImage
from glrt.image.film_state import FilmState
from glrt.image.image import Image
from glrt.image.moments import Moments
from glrt.image.particle_film import ParticleFilm, observations_of

# Films, in addition to those of AOVs. That of groups of shared numbers has them below each other.
RADIANCE, PARTICLES, GROUPS = "radiance", "particles", "groups"
NOTHING = np.zeros((1, 1, 1))


def moments_of(image: Image, film: str) -> Moments | None:
    """Moments of a film: of radiance, particles, groups or an AOV; None if its state is lacking."""
    aovs = {str(aov): found for aov, found in image.aovs.items()}
    if film in aovs:
        return _of_aov(aovs[film])
    if film == PARTICLES and image.particles and image.recipe:
        count = observations_of(image.samples, image.recipe.settings.division.points)
        return _of_particles(image.particles, count)
    if image.film_state is None:
        return None
    if film == GROUPS:
        return _of_groups(image.film_state)
    return _of_radiance(image, image.film_state) if film == RADIANCE else None


def groups_of(moments: Moments, count: int) -> NDArray[np.float32]:
    """The means of groups and their samples, (count, H, W, 4), from the moments of GROUPS."""
    rows = np.concatenate([moments.mean, moments.samples], axis=-1).astype(np.float32)
    return rows.reshape(count, -1, *rows.shape[1:])


def _of_groups(state: FilmState) -> Moments | None:
    """Moments of groups of shared numbers, which go on from part to part."""
    if not len(state.groups):
        return None
    rows = state.groups.reshape(-1, *state.groups.shape[2:]).astype(np.float64)
    return Moments(rows[..., 3:], rows[..., :3], NOTHING, NOTHING, NOTHING, NOTHING)


def _of_radiance(image: Image, state: FilmState) -> Moments:
    begun, part = NOTHING, NOTHING  # for a film without an incomplete observation
    if state.begun.any():
        begun, part = _counts(state.begun), state.part.astype(np.float64)
    return Moments(
        _counts(image.samples - state.dropped),
        (image.particles.camera if image.particles else image.radiance).astype(np.float64),
        _counts(state.observations),
        state.variance.astype(np.float64),
        begun,
        part,
    )


def _of_particles(film: ParticleFilm, observations: int) -> Moments:
    """Moments of the film of particles, on which each sample is an observation."""
    mean, variance = film.mean.astype(np.float64), film.variance.astype(np.float64)
    count = np.full((*mean.shape[:2], 1), observations, np.float64)
    return Moments(count, mean, count, variance, NOTHING, NOTHING)


def _of_aov(aov: AovImage) -> Moments:
    """Moments of an AOV with standard errors, which holds complete observations."""
    assert aov.stderr is not None
    assert aov.count is not None
    assert aov.observations is not None
    height, width = aov.count.shape
    count, observations = _counts(aov.count), _counts(aov.observations)
    value, stderr = (part.reshape(height, width, -1) for part in (aov.value, aov.stderr))
    mean = np.where(count > 0, value, 0).astype(np.float64)
    is_known = observations >= 2
    variance = np.where(is_known, stderr, 0).astype(np.float64) ** 2 * (observations - 1)
    return Moments(count, mean, observations, variance, NOTHING, NOTHING)


def _counts(plane: NDArray[Any]) -> NDArray[np.float64]:
    return plane[..., None].astype(np.float64)
