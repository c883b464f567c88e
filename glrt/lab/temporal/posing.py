"""A mesh bends from frame to frame: whether its history follows it."""

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from glrt.lab.scenes import lamp, matte, plane, scene_of, sphere
from glrt.lab.sweep import Lab, Sweep
from glrt.lab.temporal.moving import (
    AWAY,
    FRAMES,
    SIDE,
    SPEEDS,
    TALL,
    error_on,
)
from glrt.scene.files.named_meshes import MeshFile, mesh_of_arrays
from glrt.scene.meshes.triangle_meshes import TriangleMesh
from glrt.scene.scene import Scene

HALF, CELLS = 0.8, 8  # of the banner: half an edge in scene units, cells along it
PIXEL = TALL / SIDE  # in scene units, where the banner is
LAST = FRAMES * max(SPEEDS) * PIXEL  # the moment at which the banner is upright

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Leaning:
    """A banner that leans from its middle upwards; at LAST it stands upright."""

    upright: TriangleMesh
    names: tuple[str, ...] = ("lean",)
    usual: str = "lean"
    made: dict[float, TriangleMesh] = field(default_factory=dict)

    def seconds(self, name: str) -> float:
        """Return the moment of the last pose."""
        del name
        return LAST

    def at(self, name: str | None, moment: float) -> TriangleMesh:
        """Return the banner: its upper edge is a unit aside for each unit before LAST."""
        del name
        if moment not in self.made:
            vertices = self.upright.vertices.copy()
            vertices[:, 0] += (moment - LAST) * np.maximum(vertices[:, 1], 0) / HALF
            self.made[moment] = replace(self.upright, vertices=vertices)
        return self.made[moment]


def bending(lab: Lab) -> Sweep:
    """Error on a banner of random colors that leans before a wall, by the speed of its edge.

    It is a mesh whose corners move one by one, as those of skins and morph targets do.
    """
    file = _banner()

    def scene(place: float) -> Scene:
        banner = {"shape": "mesh", "file": file, "material": "cloth", "time": LAST + place}
        return scene_of(
            [plane([0, 0, -1], [0, 0, 1], "wall"), banner, sphere([0.4, 2, 2.5], 0.5, "lamp")],
            {"wall": matte(0.5), "cloth": matte(0.9), "lamp": lamp(9.0)},
            {"position": [0, 0, AWAY], "look_at": [0, 0, 0], "fov": 40},
        )

    offsets = (np.arange(SIDE) + 0.5 - SIDE / 2) * PIXEL
    across, down = np.meshgrid(offsets, offsets)
    inside = (np.abs(across) < HALF - PIXEL) & (np.abs(down) < HALF - PIXEL)
    return error_on(lab, "banner", "the upper edge", scene, inside)


def _banner() -> MeshFile:
    """The mesh, with a random color at each corner."""
    steps = np.linspace(-HALF, HALF, CELLS + 1)
    x, y = (grid.ravel() for grid in np.meshgrid(steps, steps))
    first = (np.arange(CELLS)[:, None] * (CELLS + 1) + np.arange(CELLS)).ravel()
    above = first + CELLS + 1
    faces = np.concatenate(
        [np.stack([first, first + 1, above + 1], 1), np.stack([first, above + 1, above], 1)]
    )
    colors = np.random.default_rng(2).uniform(0.05, 1, (len(x), 3))
    file = mesh_of_arrays(np.stack([x, y, 0 * x], axis=1), faces, colors=colors)
    assert file.triangles
    assert file.sha256
    posed = replace(file.triangles, poses=Leaning(file.triangles))
    return file.read_as(file.sha256, posed, None)
