"""Nearby lamps in groups, and tables for drawing one of many in constant time.

Arrays in, arrays out.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]


def light_probabilities(power: Sequence[float]) -> Array:
    """How often each lamp is chosen: half by its power, half evenly, so that none is left out."""
    weight = np.asarray(power, np.float64)
    count = len(weight)
    even = np.full(count, 1 / max(count, 1))
    return even if weight.sum() == 0 else 0.5 * even + 0.5 * weight / weight.sum()


def grouped(place: Array, weight: Array, most: int) -> list[Array]:
    """Indices of nearby places, (n, 3), in `most` groups; of fewer places each is one.

    The group whose weight times variance is largest is cut in two across its longest axis, at the
    mean, until there are enough (as colours by Wan et al., SIGGRAPH Computer Graphics 1990).
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
    """Vose's tables (`keep`, `alias`) for drawing an index in constant time (IEEE TSE 1991)."""
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
    mean, variance = _spread(group, place, weight)
    axis = int(np.argmax(variance))
    ordered = group[np.argsort(place[group, axis], kind="stable")]
    below = int(np.searchsorted(place[ordered, axis], mean[axis]))
    end = min(max(below, 1), len(group) - 1)
    return [ordered[:end], ordered[end:]]


def _cost(group: Array, place: Array, weight: Array) -> float:
    """Below 0 for what cannot be cut."""
    if len(group) == 1:
        return -1.0
    return float(weight[group].sum() * _spread(group, place, weight)[1].sum())


def _spread(group: Array, place: Array, weight: Array) -> tuple[Array, Array]:
    """Mean and variance along each axis, weighted."""
    share = weight[group] / weight[group].sum()
    mean = share @ place[group]
    return mean, share @ (place[group] - mean) ** 2
