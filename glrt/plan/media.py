"""Facts about the media of a scene: which are used, and where each begins."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from glrt.core.memo import computed_once
from glrt.scene.grids import edges_of_voxels, holders_of, steps_across
from glrt.scene.loading.scene_files import check_loaded
from glrt.scene.scene import Scene
from glrt.scene.volumes import Bounds, bounds_of, has_ranks, medium_in, volume_around

RANKED = 5  # times that the bounds are looked up on a segment, where volumes have ranks
MOST_STEPS = 10_000  # of a ray through a grid: llvmpipe ends loops after 65,535 rounds


class Filling(NamedTuple):
    """A medium where it fills something; its row in the kernel."""

    medium: str
    holder: int | None  # number of the object, for a medium with a grid; None: anywhere


@dataclass(frozen=True)
class MediaFacts:
    """Facts about the media of a scene, derived when they are first used."""

    scene: Scene

    @computed_once
    def names(self) -> list[str]:
        """Names of the media that fill an object, or all of space; their rows in the kernel."""
        return self.scene.media_in_use

    @computed_once
    def grids(self) -> list[str]:
        """Names of the media whose density varies; the rows of their grids in the kernel."""
        return [name for name in self.names if self.scene.media[name].density is not None]

    @computed_once
    def rows(self) -> list[Filling]:
        """The rows of media in the kernel, without those of knots: one for each place of a grid."""
        found = {name: holders_of(self.scene, name) for name in self.grids}
        return [Filling(name, it) for name in self.names for it in found.get(name, (None,))]

    def filling(self, name: str | None, holder: int | None) -> Filling | None:
        """Return the row of a medium in an object, or with None in all of space; None: vacuum."""
        if name is None:
            return None
        return Filling(name, holder if name in self.grids else None)

    @computed_once
    def transfers(self) -> list[str]:
        """Names of the media with a transfer function."""
        return [name for name in self.names if self.scene.media[name].transfer is not None]

    def steps(self, length: float | None) -> int:
        """Return about how many steps a ray takes through all grids: see `steps_across`."""
        return sum(steps_across(self.scene, name, length) for name in self.grids)

    def beyond_steps(self, length: float) -> str | None:
        """Return why rays cannot march through the grids in steps of a length; None if they can.

        A length of 0 is that of a voxel. Raises SceneError for a scene whose files were not read.
        """
        check_loaded(self.scene)
        for name in self.grids:
            steps = steps_across(self.scene, name, length)
            if steps > MOST_STEPS:
                least = (length or max(edges_of_voxels(self.scene, name))) * steps / MOST_STEPS
                return (
                    f"--march-step {length:g} is too short for the grid of media.{name}: a ray "
                    f"through it takes {steps:,} steps, and {MOST_STEPS:,} are the most. Give at "
                    f"least {1.01 * least:.2g}."
                )
        return None

    @computed_once
    def bounds(self) -> tuple[Bounds, ...]:
        """The bounds of all volumes, in a scene that uses media."""
        shown = set(self.scene.shown)
        return tuple(it for it in bounds_of(self.scene) if it.number in shown and self.names)

    @computed_once
    def is_ranked(self) -> bool:
        """Whether volumes overlap by priority."""
        return has_ranks(self.scene)

    @property
    def rounds_of_bounds(self) -> int:
        """Rounds of loops on a segment in which a kernel looks bounds up."""
        return (2 + len(self.bounds)) * (RANKED if self.is_ranked else 1)

    @property
    def displaced(self) -> set[str]:
        """Materials of the bounds that others may displace, so that segments pass them."""
        return {self.scene.objects[it.number].material for it in self.bounds if self.is_ranked}

    @computed_once
    def camera_volumes(self) -> int:
        """The volumes around the camera, where they are ranked: a bit for each of `bounds`."""
        eye, things = np.array(self.scene.camera.position, np.float64), self.scene.objects
        holding = [things[it.number].holds(eye) for it in self.bounds if self.is_ranked]
        return sum(1 << row for row, holds in enumerate(holding) if holds)

    @computed_once
    def around_camera(self) -> Filling | None:
        """The medium around the camera; None for vacuum."""
        number = volume_around(self.scene, np.array(self.scene.camera.position, np.float64))
        return self.filling(medium_in(self.scene, number), number)
