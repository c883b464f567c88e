"""The error of what is on the screen, frame by frame, for each temporal mode.

Frames and rays are counted, and no clock decides, so that each run gives the same figures. Only
milliseconds, where a plan has rounds of them, differ from run to run.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from glrt.analysis.chart.curves import Interval
from glrt.analysis.chart.rays import Rays, rays_of
from glrt.analysis.motion.clock import milliseconds_of
from glrt.analysis.motion.playing import Played, play
from glrt.analysis.motion.sequences import Sequence as Frames
from glrt.analysis.motion.sequences import light_step, orbit
from glrt.analysis.reference import Budget, Reference, reference_for
from glrt.gpu.context import Context
from glrt.rendering.history.temporal import Way
from glrt.rendering.history.upsample import PAIR
from glrt.rendering.probe_tracer import PUSHED
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for

FRAMES = 32
DEGREES = 1.0  # per frame of an orbit
BEFORE, FACTOR = 16, 0.25  # still frames before the light is dimmed to a share of it
SURFACES = 1.0  # rays per pixel and view, for the G-buffer by which history is found again

Tell = Callable[[str, float], None]


class Seen(NamedTuple):
    """The error of a mode's picture at the end of a frame."""

    frame: int  # from 1; of a light step, from the first frame under the other light
    rays: float  # that the frame took, per pixel
    squared_error: float  # unbiased estimate; it may be negative

    @property
    def error(self) -> float:
        """Relative RMS error; 0 where the estimate of its square is negative."""
        return math.sqrt(max(self.squared_error, 0.0))


def by_probes(settings: Settings, hysteresis: Sequence[float]) -> dict[str, Played]:
    """Ways to play by `ddgi`: with new probes for each picture, and live by each hysteresis."""
    own, alone = settings_for(settings, method="ddgi", sampler="sobol"), Way("reset")
    live = {f"ddgi, live {kept:g}": Played(own, alone, kept) for kept in hysteresis}
    return {"ddgi": Played(own, alone), **live} if live else {}


def enlargement(played: Played, rays: Rays) -> Played:
    """A picture of fewer pixels, a sample of each in a frame, that takes the rays of `upsample`."""
    settings, k = played.settings, played.way.factor
    share = (SURFACES + PAIR * rays.sample / k**2) / rays.sample  # of the pixels
    side = math.sqrt(min(share, 1.0))
    width, height = (max(1, round(side * pixels)) for pixels in settings.size)
    reduced = settings_for(settings, width=width, height=height)
    return Played(reduced, Way("reset"), enlarged=settings.size)


class TrackPlan(NamedTuple):
    """The ways that tracks show, and their numbers of samples."""

    ways: Sequence[Way]
    hysteresis: Sequence[float]  # of live probes: a track for each, and one with new probes
    reference_samples: int  # of each half of a frame's reference, at most
    samples: int = 1  # of each frame
    rounds: int = 0  # in which frames are timed; 0: no clock is read


class Track(NamedTuple):
    """One mode in one sequence of one scene."""

    scene: str
    sequence: str
    mode: str  # and predictor
    seen: tuple[Seen, ...]
    milliseconds: Interval | None = None  # of a frame: median and quartiles; None: not timed

    @property
    def mean_error(self) -> float:
        """Mean error over the frames that were looked at."""
        return sum(one.error for one in self.seen) / len(self.seen)


def tracks_of(
    name: str,
    scene: Scene,
    settings: Settings,
    context: Context,
    plan: TrackPlan,
    report: Tell,
) -> list[Track]:
    """Tracks of the orbit and the light step of a scene, by each way of the plan.

    Each frame that is looked at has a reference of its own, in two halves.
    """
    plain = {way.name: Played(settings, way) for way in plan.ways}
    all_played = plain | by_probes(settings, plan.hysteresis)
    own = rays_of(scene, settings, context)
    for one in [one for one in plain.values() if one.way.mode == "upsample"]:
        all_played[f"enlarged for {one.way.name}"] = enlargement(one, own)
    rays = {one: rays_of(scene, one, context) for one in {p.settings for p in all_played.values()}}
    found = []
    sequences = orbit(scene, FRAMES, DEGREES), light_step(scene, FRAMES, BEFORE, FACTOR)
    for place, frames in enumerate(sequences):
        looks = looks_of(frames)
        truth: dict[int, Reference] = {}
        for done, look in enumerate(looks):
            report(f"{name}, {frames.name}: references", (place + 0.8 * done / len(looks)) / 2)
            known = [truth[n] for n in truth if frames.scenes[n] == frames.scenes[look]]
            budget = Budget(0.0, math.inf, plan.reference_samples)
            wanted = frames.scenes[look], settings, context, budget
            truth[look] = known[0] if known else reference_for(*wanted)
        for number, (mode, one) in enumerate(all_played.items()):
            share = (place + 0.8 + 0.2 * number / len(all_played)) / 2
            report(f"{name}, {frames.name}: {mode}", share)
            seen = _seen(frames, truth, rays[one.settings], context, one, plan.samples)
            found.append(Track(name, frames.name, mode, tuple(seen)))
        if plan.rounds:

            def begun(number: int, name: str = f"{name}, {frames.name}", done: int = place) -> None:
                report(f"{name}: round {number + 1} of {plan.rounds}", (done + 1) / 2)

            timed = frames, all_played, context, plan.samples, plan.rounds
            times = milliseconds_of(*timed, begun)
            modes = len(all_played)
            found[-modes:] = [t._replace(milliseconds=times[t.mode]) for t in found[-modes:]]
    return found


def looks_of(frames: Frames) -> list[int]:
    """The frames to look at: the first four of an orbit or after a step, then every fourth."""
    if frames.name == "orbit":
        return [0, 1, 2, 3, *range(5, len(frames.scenes), 4)]
    after = range(BEFORE, len(frames.scenes))
    return [*after[:4], *after[5::4]]


def _seen(
    frames: Frames,
    truth: dict[int, Reference],
    rays: Rays,
    context: Context,
    one: Played,
    samples: int,
) -> Iterator[Seen]:
    first = frames.first
    before = None
    more: list[float] = []
    for number, picture in enumerate(play(frames, one, context, samples, more)):
        is_new = frames.scenes[number] != before
        before = frames.scenes[number]
        found = SURFACES if one.way.mode != "reset" and is_new else 0.0
        if number in truth:
            squared = truth[number].squared_error(picture)
            own = rays.sample * (samples + more[-1]) + _of_probes(rays, one, number, is_new, frames)
            yield Seen(1 + number - first, (own + found) * _share_of_pixels(one), squared)


def _share_of_pixels(one: Played) -> float:
    """Pixels that are rendered for one that is shown."""
    return math.prod(one.settings.size) / math.prod(one.enlarged or one.settings.size)


def _of_probes(rays: Rays, one: Played, number: int, is_new: bool, frames: Frames) -> float:
    """Rays from probes in a frame, per pixel; live ones are placed again when the eye moves."""
    if one.hysteresis is None or not number:
        return rays.set + rays.once if is_new else 0.0
    return rays.of_update(1 + (PUSHED + 1) * (frames.name == "orbit"))
