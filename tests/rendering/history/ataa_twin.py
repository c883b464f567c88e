"""The mask and the filter of adaptive temporal antialiasing, written independently in numpy."""

from typing import Any

import numpy as np

from tests.rendering.history.twins import Array

LUMA = np.array([0.299, 0.587, 0.114])


def failure(
    place: Array, known: Array, off: Array, contrast: Array, is_edge: Array, is_specular: Array
) -> Array:
    """The mask's number of each pixel. `place`, (n, 2): how far it moved; x < 0: from outside."""
    is_rough = is_edge | (contrast > 0.25)
    moved = np.hypot(place[:, 0], place[:, 1])
    rules = [
        (place[:, 0] < 0, 1),
        (known <= 0, 3),
        (is_specular & (moved > 0.25), 3),
        (is_rough & (off > 0.1), 3),
        (is_rough & (known < 8), 2),
    ]
    return np.select([rule for rule, _ in rules], [number for _, number in rules], 0)


def fxaa(light: Array) -> Array:
    """A picture (H, W, 3) of radiance, filtered along its edges."""
    luma = light @ LUMA
    mapped = light / (1 + luma)[..., None]
    shown = np.empty_like(mapped)
    for y in range(len(light)):
        for x in range(len(light[0])):
            shown[y, x] = _filtered(mapped, np.array([x + 0.5, y + 0.5]))
    return np.asarray(shown / (1 - shown @ LUMA)[..., None])


def _filtered(mapped: Array, at: Array) -> Array:
    corners = [(-1, -1), (1, -1), (-1, 1), (1, 1)]
    middle = _between(mapped, at)
    nw, ne, sw, se = lumas = [_between(mapped, at + np.array(c) / 2) @ LUMA for c in corners]
    low, high = min(*lumas, middle @ LUMA), max(*lumas, middle @ LUMA)
    if high - low < max(1 / 16, high / 8):
        return middle
    along: Any = np.array([sw + se - nw - ne, nw + sw - ne - se])
    along = np.clip(along / (np.abs(along).min() + max(sum(lumas) / 32, 1 / 128)), -8, 8)
    taps = [_between(mapped, at + share * along) for share in (-1 / 6, 1 / 6, -0.5, 0.5)]
    inner, outer = sum(taps[:2]) / 2, sum(taps) / 4
    return np.asarray(outer if low <= outer @ LUMA <= high else inner)


def _between(picture: Array, at: Array) -> Array:
    height, width, _ = picture.shape
    left, top = np.floor(at - 0.5).astype(int)
    x, y = at - 0.5 - (left, top)
    rows, columns = (np.clip([one, one + 1], 0, n - 1) for one, n in ((top, height), (left, width)))
    parts = picture[np.ix_(rows, columns)]
    return np.asarray(np.einsum("j,i,jic->c", [1 - y, y], [1 - x, x], parts))
