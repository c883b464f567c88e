"""Clusters of nearby lamps, and alias tables for drawing one of many lamps in constant time.

All functions take and return arrays.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]


def light_probabilities(power: Sequence[float]) -> Array:
    """Return the probability of choosing each lamp, (n,): half proportional to power, half uniform.

    Every lamp has a probability above 0. It is uniform if the total power is 0.
    """
    weight = np.asarray(power, np.float64)
    count = len(weight)
    even = np.full(count, 1 / max(count, 1))
    return even if weight.sum() == 0 else 0.5 * even + 0.5 * weight / weight.sum()


def grouped(place: Array, weight: Array, most: int) -> list[Array]:
    """Divide the points `place`, (n, 3), into `most` groups; return the indices of each group.

    With `most` points or fewer, each is a group. Otherwise the group with the largest product of
    total weight and variance is split at its weighted mean, along its axis of largest variance,
    until there are enough (as for colours: Wan et al., "Variance-based color image quantization for
    frame buffer display", Color Research & Application 1990).
    """
    count = len(weight)
    if count <= most:
        return [np.array([index]) for index in range(count)]
    groups = [np.arange(count)]
    costs = [1.0]
    while len(groups) < most:
        widest = int(np.argmax(costs))
        parts = _cut(groups[widest], place, weight)
        groups[widest : widest + 1] = parts
        costs[widest : widest + 1] = [_cost(part, place, weight) for part in parts]
    return groups


def alias_table(probability: Array) -> tuple[Array, Array]:
    """Return Vose's tables (`keep`, `alias`), (n,) each, for `probability`, (n,) (IEEE TSE 1991).

    To draw an index in constant time, draw i uniformly, and take i with probability keep[i],
    else alias[i].
    """
    count = len(probability)
    keep, alias = np.ones(count), np.arange(count)
    share = np.asarray(probability, np.float64) * count
    small = [i for i in range(count) if share[i] < 1]
    large = [i for i in range(count) if share[i] >= 1]
    while small and large:
        low, high = small.pop(), large[-1]
        keep[low], alias[low] = share[low], high
        share[high] -= 1 - share[low]
        if share[high] < 1:
            small.append(large.pop())
    return keep, alias


def _cut(group: Array, place: Array, weight: Array) -> list[Array]:
    """Split a group in two non-empty parts, at its mean along the axis of largest variance."""
    mean, variance = _spread(group, place, weight)
    axis = int(np.argmax(variance))
    ordered = group[np.argsort(place[group, axis], kind="stable")]
    below = int(np.searchsorted(place[ordered, axis], mean[axis]))
    end = min(max(below, 1), len(group) - 1)
    return [ordered[:end], ordered[end:]]


def _cost(group: Array, place: Array, weight: Array) -> float:
    """Return total weight times variance of a group; -1 for a point, which cannot be split."""
    if len(group) == 1:
        return -1.0
    return float(weight[group].sum() * _spread(group, place, weight)[1].sum())


def _spread(group: Array, place: Array, weight: Array) -> tuple[Array, Array]:
    """Return weighted mean and variance of the points of a group along each axis, (3,) each."""
    share = weight[group] / weight[group].sum()
    mean = share @ place[group]
    return mean, share @ (place[group] - mean) ** 2
