"""The two halves of a picture: its first samples, and those that came after them."""

from collections.abc import Iterator

import numpy as np

from glrt.denoise.half import Guide, Half, Pixels
from glrt.image.film_moments import PARTICLES, RADIANCE, moments_of
from glrt.image.film_state import error_of_mean
from glrt.image.image import Image
from glrt.image.moments import Moments, without
from glrt.settings import GUIDES


def halves_of(first: Image, whole: Image) -> tuple[Half, Half]:
    """What the first samples of a render tell, and what the rest of them do.

    `first` is the picture of the same render when it had fewer samples, whole observations; both
    hold the state of their films and the guides of a denoiser. The halves are independent where
    samples are; they need not be of one size.
    """
    share = first.samples / whole.samples
    films = [RADIANCE, *([PARTICLES] if whole.particles else [])]
    sums = zip(*(_parts(film, first, whole) for film in films), strict=True)
    guides = zip(*(_parts(guide, first, whole) for guide in GUIDES), strict=True)
    halves = [
        Half(*_summed(moments), part, *map(_guide, found))
        for moments, found, part in zip(sums, guides, (share, 1 - share), strict=True)
    ]
    return halves[0], halves[1]


def _parts(film: str, first: Image, whole: Image) -> tuple[Moments, Moments]:
    early, all_ = moments_of(first, film), moments_of(whole, film)
    assert early is not None, f"the picture holds no {film}"
    assert all_ is not None, f"the picture holds no {film}"
    return early, without(all_, early)


def _summed(films: tuple[Moments, ...]) -> tuple[Pixels, Pixels]:
    """Mean of a sum of films and its variance, which add as the films are independent."""
    means, variances = zip(*map(_mean_and_variance, films), strict=True)
    return np.sum(means, axis=0, dtype=np.float32), np.sum(variances, axis=0, dtype=np.float32)


def _mean_and_variance(film: Moments) -> Iterator[Pixels]:
    """The latter is 0 where a pixel has too few observations, as where its samples were dropped."""
    mean, observations = film.mean.astype(np.float32), film.observations[..., 0]
    part = np.broadcast_to(film.part, film.mean.shape)
    share = np.broadcast_to(film.begun / np.maximum(film.samples, 1), film.samples.shape)[..., 0]
    error = error_of_mean(
        mean, *(x.astype(np.float32) for x in (film.variance, observations, part, share))
    )
    yield mean
    yield np.square(np.nan_to_num(error, nan=0.0))


def _guide(film: Moments) -> Guide:
    return Guide(*_mean_and_variance(film))
