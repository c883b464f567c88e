"""Upsampled against enlarged coarse pictures at equal work: `python -m bench.upsampling`.

An orbit, and a light that is dimmed to a quarter, as in `glrt chart --temporal`. Work is counted in
rays, so that each run gives the same figures. With `--equal time` the enlarged pictures have as
many pixels as can be rendered in the time of an upsampled one; their size and the ratio of times in
interleaved rounds are printed, too. FLIP takes the package flip-evaluator.
"""

import argparse
import math
import statistics
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from bench.program import exit_code_of, machine
from bench.ratios import LEAST_ROUNDS, Ratio, ratio_of
from glrt.analysis.chart.flip import flip
from glrt.analysis.chart.rays import rays_of
from glrt.analysis.motion.measure import BEFORE, DEGREES, FACTOR, FRAMES, enlargement, looks_of
from glrt.analysis.motion.playing import Played, play
from glrt.analysis.motion.sequences import Sequence, light_step, orbit
from glrt.analysis.reference import Budget, Reference, reference_for
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.image.tonemap import expose_and_encode
from glrt.rendering.history.lattice import FACTORS
from glrt.rendering.history.temporal import Way
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings, settings_for

SCENES = ("cornell", "lamps")
REFERENCE = 512  # samples of each half
FITS = 4  # times that the size of a picture is scaled by the ratio of times
HEAD = (
    "| scene | what moves | one pixel in | RMS, enlarged | upsampled | FLIP, enlarged | upsampled |"
)
TIMED = " enlarged from | time of enlarged over upsampled |"


class Errors(NamedTuple):
    """Means over the frames of a sequence that are looked at."""

    rms: float  # relative
    flip: float


def main(arguments: list[str] | None = None) -> int:
    """Measure both ways, or make a picture of them; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m bench.upsampling", description=__doc__)
    parser.add_argument("--scene", nargs="+", default=SCENES)
    parser.add_argument("--size", type=int, nargs=2, default=(128, 96), metavar=("W", "H"))
    parser.add_argument("--equal", choices=("rays", "time"), default="rays", help="default: rays")
    parser.add_argument("--rounds", type=int, default=LEAST_ROUNDS, help="of --equal time")
    parser.add_argument("--picture", type=Path, metavar="FILE", help="of both, without figures")
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    context, size = open_context(), {"width": parsed.size[0], "height": parsed.size[1]}
    scenes = {name: load(name) for name in parsed.scene}
    sized = {name: settings_for(scene.render, **size) for name, scene in scenes.items()}
    if parsed.picture:
        strips = [strip(scenes[name], sized[name], context) for name in scenes]
        Image.fromarray(np.vstack(strips)).save(parsed.picture, quality=85)
        return
    rounds = parsed.rounds if parsed.equal == "time" else 0
    head = HEAD + (TIMED if rounds else "")
    print(f"{head}\n{'|---' * (head.count('|') - 1)}|")
    for name, scene in scenes.items():
        for frames in orbit(scene, FRAMES, DEGREES), light_step(scene, FRAMES, BEFORE, FACTOR):
            for row in rows(name, frames, sized[name], context, rounds):
                print(row, flush=True)
    if rounds:
        print(f"\n{machine(context.renderer)}; {parsed.size[0]} x {parsed.size[1]}")


def strip(scene: Scene, settings: Settings, context: Context) -> NDArray[np.uint8]:
    """The end of an orbit, enlarged, upsampled and converged: (H, 3 W, 3) uint8."""
    frames = orbit(scene, FRAMES, DEGREES)
    own = Played(settings, Way("upsample"))
    ways = enlargement(own, rays_of(scene, settings, context)), own
    shown = [list(play(frames, one, context))[-1] for one in ways]
    with_truth = Renderer(frames.scenes[-1], settings, context)
    shown.append(with_truth.render(2 * REFERENCE).image().radiance)
    with_truth.release()
    return np.hstack([expose_and_encode(one, 0.0, settings.tonemap) for one in shown])


def rows(
    name: str, frames: Sequence, settings: Settings, context: Context, rounds: int
) -> Iterator[str]:
    """A row of the table for each factor; of equal time if there are rounds, else of equal rays."""
    truths: dict[int, Reference] = {}
    for look in looks_of(frames):
        same = [truths[n] for n in truths if frames.scenes[n] == frames.scenes[look]]
        budget = Budget(0.0, math.inf, REFERENCE)
        truths[look] = (same or [reference_for(frames.scenes[look], settings, context, budget)])[0]
    rays = rays_of(frames.scenes[0], settings, context)
    for factor in FACTORS:
        own = Played(settings, Way("upsample", factor=factor))
        other, timed = enlargement(own, rays), ""
        if rounds:
            other, ratio = fitted(own, other, frames, context, rounds)
            timed = f" {' x '.join(map(str, other.settings.size))} | {ratio} |"
        large, made = (_errors(frames, truths, one, context) for one in (other, own))
        figures = f"{large.rms:.3f} | {made.rms:.3f} | {large.flip:.3f} | {made.flip:.3f}"
        yield f"| {name} | {frames.name} | {factor} x {factor} | {figures} |{timed}"


def fitted(
    own: Played, other: Played, frames: Sequence, context: Context, rounds: int
) -> tuple[Played, Ratio]:
    """An enlargement that takes the time of upsampling, and the ratio of their times."""
    for _ in range(FITS):
        other = _resized(other, _seconds(frames, own, context) / _seconds(frames, other, context))
    times = [[_seconds(frames, one, context) for one in (other, own)] for _ in range(rounds)]
    these, those = zip(*times, strict=True)
    return other, ratio_of(these, those)


def _resized(played: Played, ratio: float) -> Played:
    """Enlargement from a ratio of the pixels, at most all."""
    assert played.enlarged
    pairs = zip(played.settings.size, played.enlarged, strict=True)
    width, height = (min(max(1, round(now * math.sqrt(ratio))), most) for now, most in pairs)
    return played._replace(settings=settings_for(played.settings, width=width, height=height))


def _seconds(frames: Sequence, played: Played, context: Context) -> float:
    """Median time of a frame. A screen enlarges pictures itself, so this is not in it."""
    times, began = [], time.perf_counter()
    for _ in play(frames, played._replace(enlarged=None), context):
        times.append(time.perf_counter() - began)
        began = time.perf_counter()
    return statistics.median(times[1:])


def _errors(
    frames: Sequence, truths: dict[int, Reference], one: Played, context: Context
) -> Errors:
    squares, flips = [], []
    for number, picture in enumerate(play(frames, one, context)):
        if truth := truths.get(number):
            squares.append(math.sqrt(max(truth.squared_error(picture), 0.0)))
            flips.append(flip(picture, truth.radiance))
    return Errors(sum(squares) / len(squares), sum(flips) / len(flips))


if __name__ == "__main__":
    raise SystemExit(main())
