"""The means of groups of shared numbers: channels of EXR files, and the error that they give.

Sample number i of a pixel is of the group i // n % R of R, where n is the number of points of a
block. The count of a group's samples follows from that of the pixel; where samples were dropped,
the file holds how many.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]
Channels = dict[str, NDArray[Any]]

NO_GROUPS: Array = np.zeros((0, 1, 1, 4), np.float32)
GROUP = "film.group"  # film.group.3.R is the red mean of group 3


def to_channels(groups: Array, samples: int, block: int) -> Channels:
    """The means of groups, (R, H, W, 4) with their finite samples, as channels of a file.

    `block` samples give each group as many.
    """
    channels: Channels = {}
    counts = _counts(samples, len(groups), block)
    for number, (group, count) in enumerate(zip(groups, counts, strict=True)):
        channels[f"{GROUP}.{number}"] = np.ascontiguousarray(group[..., :3])
        dropped = count - group[..., 3]
        if dropped.any():
            channels[f"{GROUP}.{number}.dropped"] = dropped.astype(np.uint32)
    return channels


def from_channels(
    planes: Mapping[str, NDArray[Any]],
    size: tuple[int, ...],
    samples: int,
    count: int,
    block: int,
) -> Array | None:
    """Read what `to_channels` has written, (R, H, W, 4) float32; None if channels are missing.

    `planes` are of `size` (H, W), and there are `count` groups.
    """
    if not count:
        return NO_GROUPS
    names = [[f"{GROUP}.{number}.{color}" for color in "RGB"] for number in range(count)]
    if not all(name in planes for row in names for name in row):
        return None
    none = np.zeros(size, np.float32)
    groups = np.empty((count, *size, 4), np.float32)
    for number, taken in enumerate(_counts(samples, count, block)):
        for color, name in enumerate(names[number]):
            groups[number, ..., color] = planes[name]
        groups[number, ..., 3] = taken - planes.get(f"{GROUP}.{number}.dropped", none)
    return groups


def judged(groups: NDArray[Any]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Variance of an observation, (H, W, 3), and the number of groups with samples, (H, W).

    `groups` is (R, H, W, 4). The variance is (n - 1) times that of the mean, from the n groups with
    samples. Their shares w of all samples may differ: the variance of the mean is
    sum(w^2 (m - mean)^2) / (1 - sum(w^2)) over the means m of the groups. This is exact for equal
    shares, and for independent samples.
    """
    means, counts = groups[..., :3].astype(np.float64), groups[..., 3:].astype(np.float64)
    shares = counts / np.maximum(counts.sum(axis=0), 1)
    squares = np.square(shares * (means - (shares * means).sum(axis=0))).sum(axis=0)
    rest = 1 - np.square(shares).sum(axis=0)
    held = (counts > 0).sum(axis=0).astype(np.float64)
    known = np.where(held > 1, (held - 1) / np.where(held > 1, rest, 1), 0)
    return squares * known, held[..., 0]


def _counts(samples: int, groups: int, block: int) -> list[np.float32]:
    """Samples of each group, of `samples` per pixel."""
    run = block // max(groups, 1)  # successive samples of one group
    whole, rest = divmod(samples, block)
    ends = (min(max(rest - run * number, 0), run) for number in range(groups))
    return [np.float32(whole * run + end) for end in ends]
