"""Means and variances of disjoint sets of samples, combined in float64.

Chan, Golub and LeVeque, "Updating Formulae and a Pairwise Algorithm for Computing Sample Variances"
(1979): pairwise, so that errors of rounding grow with the logarithm of the number of sets.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Moments(NamedTuple):
    """Moments of each pixel of a film; arrays (H, W, C), counts (H, W, 1), or what broadcasts.

    Samples are grouped into observations. All are complete, except one that may have begun at the
    end.
    """

    samples: Array  # their number
    mean: Array  # their mean
    observations: Array  # complete ones
    variance: Array  # mean squared deviation of observations from their mean
    begun: Array  # samples in the incomplete observation
    part: Array  # their mean

    @property
    def whole_mean(self) -> Array:
        """The mean of the samples in complete observations; 0 where there are none."""
        whole = self.samples - self.begun
        total = self.mean * self.samples - self.part * self.begun
        return _share(total, whole)


def merged(load: Sequence[Callable[[], Mapping[str, Moments]]]) -> Mapping[str, Moments]:
    """Combine all sets, by the names of their films; each set follows the one before it.

    Only the last may end inside an observation. Each is loaded when it is needed, so that a few are
    held at a time. Equal sets in equal order give equal bits.
    """
    if len(load) == 1:
        return load[0]()
    middle = len(load) // 2
    left, right = merged(load[:middle]), merged(load[middle:])
    return {name: combined(left[name], right[name]) for name in left}


def combined(a: Moments, b: Moments) -> Moments:
    """Combine two sets; `a` must end with a complete observation."""
    samples, observations = a.samples + b.samples, a.observations + b.observations
    mean = a.mean + (b.mean - a.mean) * _share(b.samples, samples)
    apart = b.whole_mean - a.whole_mean
    between = apart * apart * _share(a.observations * b.observations, observations)
    sums = a.variance * a.observations + b.variance * b.observations + between
    return Moments(samples, mean, observations, _share(sums, observations), b.begun, b.part)


def without(whole: Moments, first: Moments) -> Moments:
    """The set that `combined` has put after `first` to make `whole`.

    Rounding may make a variance of 0 slightly negative; it is set to 0 then.
    """
    samples, observations = whole.samples - first.samples, whole.observations - first.observations
    mean = first.mean + (whole.mean - first.mean) * _share(whole.samples, samples)
    rest = Moments(samples, mean, observations, whole.variance, whole.begun, whole.part)
    apart = rest.whole_mean - first.whole_mean
    between = apart * apart * _share(first.observations * observations, whole.observations)
    sums = whole.variance * whole.observations - first.variance * first.observations - between
    return rest._replace(variance=_share(np.maximum(sums, 0), observations))


def _share(part: Array, whole: Array) -> Array:
    zeros = np.zeros(np.broadcast(part, whole).shape)
    share: Array = np.divide(part, whole, out=zeros, where=whole > 0)
    return share
