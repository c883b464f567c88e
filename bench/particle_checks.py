"""Whether particles change the noise alone, and whether pictures with them know their error.

`python -m bench.particle_checks` prints two tables. The first compares the mean of renders with
particles to that of as many without, of other seeds: over blocks of 8 x 8 pixels and channels, the
root mean square of their difference in its standard errors, as the pictures tell them; 1 if nothing
but noise differs. The second compares the true error of pictures with particles, from renders of
other seeds, to the one that they tell, as `bench.calibration` does.
"""

import argparse
import sys
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bench.calibration import Ratio, error_ratio
from bench.efficiency import Way, renderer_of, scene_of
from bench.program import at_least, exit_code_of, machine, parser_of
from glrt.analysis.variants import LINKED
from glrt.error.estimate import block_means, block_stderr
from glrt.gpu.context import Context, open_context
from glrt.plan.facts import SceneFacts

SCENES = (
    *("cornell", "lamps", "lens", "metals", "table"),
    *("methods/caustic", "methods/gap", "methods/glass", "ground"),
)
CALIBRATED = ("cornell", "methods/caustic")
STRAIGHT = {"caustics": "on", "linked": 0.0}
WITHOUT, WITH = 1, 100_001  # first seeds

Array = NDArray[np.float64]


class Mean(NamedTuple):
    """Of blocks over some renders, (rows, columns, 3), and its standard error."""

    value: Array
    stderr: Array


def mean_of(context: Context, name: str, way: Way, first: int, given: argparse.Namespace) -> Mean:
    """The mean of renders with seeds from `first` on."""
    renderer = renderer_of(scene_of(name), way, given.size, context)
    values, squares = [], []
    for seed in range(first, first + given.renders):
        renderer.update(seed=seed)
        image = renderer.render(given.samples).image()
        values.append(block_means(image.radiance))
        squares.append(np.square(block_stderr(image.stderr)))
    renderer.release()
    return Mean(np.mean(values, axis=0), np.sqrt(np.mean(squares, axis=0) / len(values)))


def rms_apart(one: Mean, other: Mean) -> float:
    """Root mean square of their difference in standard errors; blocks without noise agree."""
    noise = np.hypot(one.stderr, other.stderr)
    apart = one.value - other.value
    assert not apart[noise == 0].any(), "blocks without noise differ"
    return float(np.sqrt(np.mean(np.square(apart[noise > 0] / noise[noise > 0]))))


def ways_of(name: str) -> Mapping[str, Way]:
    """With particles by straight links, and where the scene has balls, through them, too."""
    scene = scene_of(name)
    ways = {"straight": Way(STRAIGHT)}
    if SceneFacts(scene).particles.links:
        ways["through balls"] = Way({"caustics": "on", **LINKED})
    return ways


def compared(context: Context, given: argparse.Namespace) -> Iterator[str]:
    """The first table, as Markdown."""
    yield "| scene | links | blocks | rms of the difference |"
    yield "|---|---|---|---|"
    for name in given.scenes:
        print(f"{name} ...", file=sys.stderr, flush=True)
        plain = mean_of(context, name, Way({"caustics": "off"}), WITHOUT, given)
        for links, way in ways_of(name).items():
            found = mean_of(context, name, way, WITH, given)
            blocks = found.value[..., 0].size
            yield f"| {name} | {links} | {blocks} | {rms_apart(found, plain):.2f} |"


def calibrated(context: Context, given: argparse.Namespace) -> Iterator[str]:
    """The second table, as Markdown."""
    yield "| scene | links | true error over the one that is told |"
    yield "|---|---|---|"
    for name in given.calibrated:
        print(f"{name}: calibration ...", file=sys.stderr, flush=True)
        for links, way in ways_of(name).items():
            renderer = renderer_of(scene_of(name), way, given.size, context)
            ratio: Ratio = error_ratio(renderer, given.samples, given.repeats)
            renderer.release()
            yield f"| {name} | {links} | {ratio} |"


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.particle_checks`; returns the exit code."""
    parser = parser_of("particle_checks", __doc__)
    add = parser.add_argument
    add("--scenes", nargs="*", metavar="NAME", default=SCENES, help="to compare")
    add("--calibrated", nargs="*", metavar="NAME", default=CALIBRATED, help="to calibrate")
    add("--size", type=at_least(8), default=96, metavar="N", help="pixels a side (default: 96)")
    add("--samples", type=at_least(32), default=256, metavar="N", help="of each (default: 256)")
    add("--renders", type=at_least(1), default=8, metavar="N", help="of each way (default: 8)")
    add("--repeats", type=at_least(2), default=64, metavar="N", help="to calibrate (default: 64)")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(given: argparse.Namespace) -> None:
    context = open_context()
    print(
        f"{machine(context.renderer)}, {given.size} x {given.size} pixels, {given.samples} "
        f"samples; {given.renders} renders each way, {given.repeats} to calibrate\n"
    )
    if given.scenes:
        print("\n".join(compared(context, given)) + "\n")
    if given.calibrated:
        print("\n".join(calibrated(context, given)))
    context.gl.release()


if __name__ == "__main__":
    sys.exit(main())
