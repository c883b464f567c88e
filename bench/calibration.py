"""Compare the estimated error of pictures with the true error found from repeated renders.

Over renders with different seeds, the means of blocks of 8 x 8 pixels vary about their mean. The
figure is the RMS of that deviation over the RMS of the standard errors in the pictures: 1 if the
estimate is right, above 1 if it is too small.
"""

import argparse
import sys
from collections.abc import Iterator, Sequence
from typing import NamedTuple, get_args

import numpy as np

from bench.efficiency import Way, renderer_of, scene_of
from bench.program import exit_code_of, machine, parser_of
from glrt.core.errors import UsageError
from glrt.error.estimate import block_means, block_stderr
from glrt.gpu.context import Context, open_context
from glrt.rendering.renderer import Renderer
from glrt.settings import Sampler

SCENES = ("cornell", "lamps", "sky")
SAMPLES = (32, 40, 47, 64, 256)


class Ratio(NamedTuple):
    """True over estimated error, with its standard error from the spread over blocks."""

    value: float
    stderr: float

    def __str__(self) -> str:
        return f"{self.value:.2f} +- {self.stderr:.2f}"


def error_ratio(renderer: Renderer, samples: int, renders: int) -> Ratio:
    """The ratio for pictures of `samples` samples per pixel, with the seeds 1 to `renders`."""
    means, errors = [], []
    for seed in range(renders):
        renderer.update(seed=seed + 1)
        image = renderer.render(samples).image()
        means.append(block_means(image.radiance))
        errors.append(block_stderr(image.stderr))
    squares = np.var(means, axis=0, ddof=1) / np.square(errors).mean(axis=0)
    ratio = float(np.sqrt(squares.mean()))
    blocks = squares.mean(axis=-1)  # channels share their noise
    return Ratio(ratio, float(blocks.std(ddof=1) / np.sqrt(blocks.size) / (2 * ratio)))


def measure(
    context: Context, name: str, samples: Sequence[int], size: int, renders: int, sampler: Sampler
) -> list[Ratio]:
    """The ratio for each number of samples, for a scene at `size` x `size` pixels.

    Raises UsageError for too few samples to estimate an error.
    """
    renderer = renderer_of(scene_of(name), Way({"sampler": sampler}), size, context)
    try:
        least = 2 * renderer.settings.block
        if min(samples) < least:
            raise UsageError(f"--samples: with `{sampler}`, an error is known from {least} on.")
        return [error_ratio(renderer, count, renders) for count in samples]
    finally:
        renderer.release()


def table(found: dict[str, list[Ratio]], samples: Sequence[int]) -> Iterator[str]:
    """A row for each scene, as Markdown."""
    yield f"| scene | {' | '.join(f'{count} samples' for count in samples)} |"
    yield "|---" * (len(samples) + 1) + "|"
    for name, ratios in found.items():
        yield f"| {name} | {' | '.join(map(str, ratios))} |"


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.calibration`; returns the exit code."""
    parser = parser_of("calibration", __doc__)
    add = parser.add_argument
    add("--scenes", nargs="+", metavar="NAME", default=SCENES)
    add("--samples", nargs="+", type=int, metavar="N", default=SAMPLES)
    add("--sampler", choices=get_args(Sampler), default="sobol")
    add("--size", type=int, default=32, metavar="N", help="pixels a side (default: 32)")
    add("--renders", type=int, default=256, metavar="N", help="renders per ratio (default: 256)")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> None:
    context = open_context()
    print(f"{machine(context.renderer)}, {parsed.size} x {parsed.size} pixels, {parsed.sampler}\n")
    found = {}
    for name in parsed.scenes:
        print(f"{name} ...", file=sys.stderr)
        found[name] = measure(
            context, name, parsed.samples, parsed.size, parsed.renders, parsed.sampler
        )
    print("\n".join(table(found, parsed.samples)))


if __name__ == "__main__":
    sys.exit(main())
