"""The error of what is on the screen, frame by frame, for each temporal mode.

By frames and counted rays: no clock decides, so that each run gives the same figures.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from glrt.analysis.chart.rays import rays_per_sample
from glrt.analysis.motion.playing import play
from glrt.analysis.motion.sequences import Sequence as Frames
from glrt.analysis.motion.sequences import light_step, orbit
from glrt.analysis.reference import Reference, reference_for
from glrt.gpu.context import Context
from glrt.rendering.temporal import Way
from glrt.scene.scene import Scene
from glrt.settings import Settings

FRAMES = 32
DEGREES = 1.0  # a frame, of an orbit
BEFORE, FACTOR = 16, 0.25  # still frames before the light is dimmed to a share of it
SURFACES = 1.0  # ray for each pixel and view, by which history is found again

Tell = Callable[[str, float], None]


class Seen(NamedTuple):
    """What a mode shows at the end of a frame."""

    frame: int  # from 1; of a light step, from the first frame under the other light
    rays: float  # that the frame took, for each pixel
    squared_error: float  # unbiased estimate; it may be negative

    @property
    def error(self) -> float:
        """Relative RMS; 0 where the estimate of its square is below."""
        return math.sqrt(max(self.squared_error, 0.0))


class Track(NamedTuple):
    """One mode in one sequence of one scene."""

    scene: str
    sequence: str
    mode: str  # and predictor
    seen: tuple[Seen, ...]

    @property
    def mean_error(self) -> float:
        """Over the frames that were looked at."""
        return sum(one.error for one in self.seen) / len(self.seen)


def tracks_of(
    name: str,
    scene: Scene,
    settings: Settings,
    context: Context,
    ways: Sequence[Way],
    reference_samples: int,
    tell: Tell,
    samples: int = 1,
) -> list[Track]:
    """The orbit and the light step of a scene, by each way at `samples` samples a frame.

    Each look has a reference of its own, two halves of at most `reference_samples` samples.
    """
    rays = samples * rays_per_sample(scene, settings, context)
    found = []
    sequences = orbit(scene, FRAMES, DEGREES), light_step(scene, FRAMES, BEFORE, FACTOR)
    for place, frames in enumerate(sequences):
        looks = looks_of(frames)
        truth: dict[int, Reference] = {}
        for done, look in enumerate(looks):
            tell(f"{name}, {frames.name}: references", (place + 0.8 * done / len(looks)) / 2)
            known = [truth[n] for n in truth if frames.scenes[n] == frames.scenes[look]]
            wanted = frames.scenes[look], settings, context, 0.0, math.inf
            truth[look] = known[0] if known else reference_for(*wanted, samples=reference_samples)
        for number, way in enumerate(ways):
            tell(f"{name}, {frames.name}: {way.name}", (place + 0.8 + 0.2 * number / len(ways)) / 2)
            seen = _seen(frames, truth, rays, settings, context, way, samples)
            found.append(Track(name, frames.name, way.name, tuple(seen)))
    return found


def looks_of(frames: Frames) -> list[int]:
    """Frames at which the screen is looked at: each of an orbit in steps, more after a step."""
    if frames.name == "orbit":
        return [0, 1, 2, 3, *range(5, len(frames.scenes), 4)]
    after = range(BEFORE, len(frames.scenes))
    return [*after[:4], *after[5::4]]


def _seen(
    frames: Frames,
    truth: dict[int, Reference],
    rays: float,
    settings: Settings,
    context: Context,
    way: Way,
    samples: int,
) -> Iterator[Seen]:
    first = 0 if frames.name == "orbit" else BEFORE
    before = None
    more: list[float] = []
    played = play(frames, settings, context, way, samples, more=more)
    for number, picture in enumerate(played):
        is_new = frames.scenes[number] != before
        before = frames.scenes[number]
        found = SURFACES if way.mode != "reset" and is_new else 0.0
        if number in truth:
            squared = truth[number].squared_error(picture)
            own = rays * (1 + more[-1] / samples)
            yield Seen(1 + number - first, own + found, squared)
