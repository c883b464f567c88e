"""The means of a picture's nets, by scrambles: channels of EXR files, and the error that they give.

Sample number i of a pixel is of the scramble i // n % R of R, where n is 1, or the points of a
block of shared numbers. The count of a scramble's samples follows from that of the pixel; where
samples were dropped, the file holds how many.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]
Channels = dict[str, NDArray[Any]]

NO_NET: Array = np.zeros((0, 1, 1, 4), np.float32)
NET = "film.net"  # film.net.3.R is the red mean of scramble 3


def to_channels(net: Array, samples: int, block: int) -> Channels:
    """The means of scrambles, (R, H, W, 4) with their finite samples, as channels of a file.

    `block` samples give each scramble as many.
    """
    channels: Channels = {}
    counts = _counts(samples, len(net), block)
    for number, (scramble, count) in enumerate(zip(net, counts, strict=True)):
        channels[f"{NET}.{number}"] = np.ascontiguousarray(scramble[..., :3])
        dropped = count - scramble[..., 3]
        if dropped.any():
            channels[f"{NET}.{number}.dropped"] = dropped.astype(np.uint32)
    return channels


def from_channels(
    planes: Mapping[str, NDArray[Any]],
    size: tuple[int, ...],
    samples: int,
    scrambles: int,
    block: int,
) -> Array | None:
    """Read what `to_channels` has written, (R, H, W, 4) float32; None if channels are missing.

    `planes` are of `size` (H, W).
    """
    if not scrambles:
        return NO_NET
    names = [[f"{NET}.{number}.{color}" for color in "RGB"] for number in range(scrambles)]
    if not all(name in planes for row in names for name in row):
        return None
    none = np.zeros(size, np.float32)
    net = np.empty((scrambles, *size, 4), np.float32)
    for number, count in enumerate(_counts(samples, scrambles, block)):
        for color, name in enumerate(names[number]):
            net[number, ..., color] = planes[name]
        net[number, ..., 3] = count - planes.get(f"{NET}.{number}.dropped", none)
    return net


def judged(net: NDArray[Any]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Variance of an observation, (H, W, 3), and the number of scrambles with samples, (H, W).

    `net` is (R, H, W, 4). As `judge_net` of shaders_glsl/film/net.glsl, in float64.
    """
    means, counts = net[..., :3].astype(np.float64), net[..., 3:].astype(np.float64)
    shares = counts / np.maximum(counts.sum(axis=0), 1)
    squares = np.square(shares * (means - (shares * means).sum(axis=0))).sum(axis=0)
    rest = 1 - np.square(shares).sum(axis=0)
    held = (counts > 0).sum(axis=0).astype(np.float64)
    known = np.where(held > 1, (held - 1) / np.where(held > 1, rest, 1), 0)
    return squares * known, held[..., 0]


def _counts(samples: int, scrambles: int, block: int) -> list[np.float32]:
    """Samples of each scramble, of `samples` per pixel."""
    run = block // max(scrambles, 1)  # successive samples of one scramble
    whole, rest = divmod(samples, block)
    ends = (min(max(rest - run * number, 0), run) for number in range(scrambles))
    return [np.float32(whole * run + end) for end in ends]
