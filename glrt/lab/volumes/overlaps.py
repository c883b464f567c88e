"""Volumes that overlap: the one of the higher priority holds the place."""

from typing import Any

import numpy as np

from glrt.lab.scenes import scene_of
from glrt.lab.sweep import Lab, Sweep, mean_of

FIRST, SECOND = 1.0, 2.0  # absorption per unit length of two slabs, each 1 deep
MOST = 2e-5  # error that is promised
EVEN = {"bottom": [1.0] * 3, "top": [1.0] * 3}
SIZE: dict[str, Any] = {"width": 8, "height": 8, "bounces": 0}


def overlap(lab: Lab) -> Sweep:
    """Error of the light behind two slabs, by the depth in which they overlap."""
    x = [*(10.0 ** -np.arange(4.0, 0.5, -1)).tolist(), 0.9]
    return Sweep(
        parameter="depth in which two absorbing slabs overlap, each 1 deep",
        measure="relative error of the light that is left",
        x=x,
        chosen=("glrt: the higher priority is there", [_error(lab, depth) for depth in x]),
        others={"what was entered last is there": [_naive(depth) for depth in x]},
        promise=f"at most {MOST:.0e} of the light",
        bound=[MOST] * len(x),
    )


def _error(lab: Lab, depth: float) -> float:
    slabs = [(0.0, "first", 1), (1.0 - depth, "second", 0)]
    bodies = [
        {
            "shape": "box",
            "min": [-1.0 - rank, -1.0 - rank, -start - 1],
            "max": [1.0 + rank, 1.0 + rank, -start],
            "material": "none",
            "medium": name,
            "priority": rank,
        }
        for start, name, rank in slabs
    ]
    media = {"first": {"absorption": [FIRST] * 3}, "second": {"absorption": [SECOND] * 3}}
    eye = {"position": [0, 0, 1], "look_at": [0, 0, -1], "fov": 1e-4}
    scene = scene_of(bodies, {}, eye, media=media, background=EVEN)
    mean, _ = mean_of(lab.render(scene, 1, **SIZE))
    return float(abs(mean / np.exp(-FIRST - SECOND * (1 - depth)) - 1))


def _naive(depth: float) -> float:
    """Return the error where a path leaves all media with the volume that it entered first."""
    left = np.exp(-FIRST * (1 - depth) - SECOND * depth)
    return float(abs(left / np.exp(-FIRST - SECOND * (1 - depth)) - 1))
