"""Split a picture into its first samples and the rest of them."""

from collections.abc import Iterator

import numpy as np

from glrt.denoise.half import Guide, Half, Pixels
from glrt.image.film_moments import PARTICLES, RADIANCE, moments_of
from glrt.image.film_state import error_of_mean
from glrt.image.image import Image
from glrt.image.moments import Moments, without
from glrt.settings import GUIDES

Light = tuple[Pixels, Pixels]


def halves_of(first: Image, whole: Image) -> tuple[Half, Half]:
    """The first samples of a render and the rest of them, as two halves.

    `first` is the picture of the same render when it had fewer samples, in complete observations.
    Both pictures hold the state of their films and the guides of a denoiser. The halves are
    independent where samples are; they need not have the same size.
    """
    share = first.samples / whole.samples
    guides = zip(*(_parts(guide, first, whole) for guide in GUIDES), strict=True)
    halves = [
        Half(*light, part, *map(_guide, found))
        for light, found, part in zip(_light(first, whole), guides, (share, 1 - share), strict=True)
    ]
    return halves[0], halves[1]


def _light(first: Image, whole: Image) -> Iterator[Light]:
    """Yield mean and variance of the first samples, then of the rest, (H, W, 3) each.

    The films are independent, so their means and their variances add.
    """
    films = [_of_film(RADIANCE, first, whole)]
    if whole.particles:
        films.append(_of_film(PARTICLES, first, whole))
    for halves in zip(*films, strict=True):
        means, variances = zip(*halves, strict=True)
        yield np.sum(means, axis=0, dtype=np.float32), np.sum(variances, axis=0, dtype=np.float32)


def _of_film(film: str, first: Image, whole: Image) -> tuple[Light, Light]:
    if film == RADIANCE and first.sums and whole.sums:
        early, late = first.sums, whole.sums.without(first.sums)
        return (early.mean, early.variance), (late.mean, late.variance)
    before, after = (_mean_and_variance(part) for part in _parts(film, first, whole))
    return before, after


def _parts(film: str, first: Image, whole: Image) -> tuple[Moments, Moments]:
    early, all_ = moments_of(first, film), moments_of(whole, film)
    assert early is not None, f"the picture holds no {film}"
    assert all_ is not None, f"the picture holds no {film}"
    return early, without(all_, early)


def _mean_and_variance(film: Moments) -> Light:
    """Mean of a film, and the variance of that mean: 0 for a pixel with too few observations."""
    mean, observations = film.mean.astype(np.float32), film.observations[..., 0]
    part = np.broadcast_to(film.part, film.mean.shape)
    share = np.broadcast_to(film.begun / np.maximum(film.samples, 1), film.samples.shape)[..., 0]
    error = error_of_mean(
        mean, *(x.astype(np.float32) for x in (film.variance, observations, part, share))
    )
    return mean, np.square(np.nan_to_num(error, nan=0.0))


def _guide(film: Moments) -> Guide:
    return Guide(*_mean_and_variance(film))
