"""Grids that are crossed in steps of a fixed length, by the method `march`, or without steps."""

from typing import Any

import numpy as np

from glrt.lab.scenes import scene_of
from glrt.lab.sweep import Lab, Sweep, mean_of
from glrt.scene.density import Density
from glrt.scene.scene import Scene

SIDE = 16  # of a picture, in pixels
DEEP = 2.0  # length of the view through the box of a grid
LAYERS = 256  # of voxels across the view
COARSE = DEEP / 16  # a step that crosses many voxels of a fine grid
MOST = 0.05  # error that is promised
EVEN = {"bottom": [1.0] * 3, "top": [1.0] * 3}


def march(lab: Lab) -> Sweep:
    """Error of the light that a layer with soft edges leaves, by the length of steps through it."""
    x = (DEEP * 2.0 ** -np.arange(8.0)).tolist()
    place = (np.arange(LAYERS) + 0.5) / LAYERS * DEEP
    layer = np.exp(
        -0.5 * np.square((place - 0.4 * DEEP) / 0.05)
    )  # e^(-1/2) at 0.05 from its middle
    scene = _through(layer[:, None, None].astype(np.float32), depth=1.0)
    ours = _error(lab, scene, 1.0)
    found = [_error(lab, scene, 1.0, method="march", march_step=step) for step in x]
    return Sweep(
        parameter="length of a step, of a view of 2 through a layer about 0.1 deep",
        measure="relative error of the light that is left",
        x=x,
        chosen=("glrt: mis, without steps", [ours] * len(x)),
        others={"march: steps with the density in their middles": found},
        promise=f"at most {MOST:.0%}",
        bound=[MOST] * len(x),
    )


def voxel(lab: Lab) -> Sweep:
    """Error of the light behind one voxel in an empty grid, by the number of its voxels."""
    x = [16, 32, 64, 128, 256]
    found: dict[str, list[float]] = {"glrt: mis, without steps": [], "march: 16 steps": []}
    steps: dict[str, Any] = {"method": "march", "march_step": COARSE}
    for edge in x:
        values = np.zeros((edge, edge, edge), np.float32)
        values[edge // 2, edge // 2, edge // 2] = 1.0
        scene = _through(values, depth=1.0)
        for way, settings in zip(found, ({}, steps), strict=True):
            found[way].append(_error(lab, scene, 1.0, **settings))
    chosen, other = found.items()
    return Sweep(
        parameter="voxels along an edge of a grid with a single dense one",
        measure="relative error of the light behind that voxel",
        x=[float(edge) for edge in x],
        chosen=chosen,
        others=dict([other]),
        promise=f"at most {MOST:.0%}",
        bound=[MOST] * len(x),
    )


def _through(values: np.ndarray[Any, Any], depth: float) -> Scene:
    """Return a box with a grid, (z, y, x), seen along z through its middle voxel.

    It only absorbs; `depth` is the optical depth of that view. Its ends are empty.
    """
    size = values.shape[0]
    middle, half = [n // 2 for n in values.shape], DEEP / 2
    along = values[:, middle[1], middle[2]].astype(np.float64)
    rate = depth / (along.sum() * DEEP / size)
    x, y = (
        (2 * m + 1) / n * half - half
        for m, n in zip(middle[:0:-1], values.shape[:0:-1], strict=True)
    )
    fog = {"absorption": [rate] * 3, "density": Density(values)}
    body = {"shape": "box", "min": [-half] * 3, "max": [half] * 3, "material": "none"}
    return scene_of(
        [{**body, "medium": "fog"}],
        {},
        {"position": [x, y, 5], "look_at": [x, y, 0], "fov": 1e-4},
        media={"fog": fog},
        background=EVEN,
    )


def _error(lab: Lab, scene: Scene, depth: float, **settings: Any) -> float:
    size: dict[str, Any] = {"width": SIDE, "height": SIDE, "bounces": 0}
    mean, _ = mean_of(lab.render(scene, lab.count(256, 64), **size, **settings))
    return float(abs(mean / np.exp(-depth) - 1))
