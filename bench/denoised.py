"""How much a denoiser gains, and whether it knows its error: tables of docs/results/denoised.md.

`python -m bench.denoised` renders six scenes and a caustic at 64 samples by 16 seeds, denoises each
picture, and compares plain and denoised pictures with the truth from two renders of other seeds:
the mean of (x - r1) (x - r2) is the squared error of a picture x, without the noise of r1 and r2.
`--truths DIR` keeps these two renders for the next run.
"""

import argparse
import math
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bench.program import at_least, exit_code_of, machine, parser_of
from bench.truth import Truth, truth_of
from glrt.denoise.filters import FILTERS, with_filter
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.settings import Settings

SCENES = ("cornell", "lamps", "lens", "metals", "sky", "weekend", "methods/caustic")
BY_PARTICLES = ("methods/caustic",)  # truths that paths alone find slowly
SAMPLES = 64
BLOCK = 32  # pixels a side of the blocks in which harm is looked for
SIGMAS = 3.0  # beyond which a block is worse for certain
HEAD = (
    "scene",
    "error, plain",
    "denoised",
    "times less",
    "estimate / true",
    "of single pictures",
    "blocks that are worse",
)

Floats = NDArray[np.float64]


class Found(NamedTuple):
    """A scene by one filter, over all seeds."""

    scene: str
    plain: float  # relative RMS error of the plain pictures
    denoised: float
    estimate: float  # the root mean square of the estimates of the pictures
    spread: float  # of the estimates of single pictures, as a share of the true error
    blocks: int
    worse: int  # blocks of them

    @property
    def gain(self) -> float:
        """How many times the error is less."""
        return self.plain / self.denoised

    @property
    def row(self) -> list[str]:
        """A row of the table."""
        percent = [f"{100 * error:.2f} %" for error in (self.plain, self.denoised)]
        ratios = f"{self.gain:.2f}", f"{self.estimate / self.denoised:.2f}", f"± {self.spread:.2f}"
        return [self.scene, *percent, *ratios, f"{self.worse} of {self.blocks}"]


def pictures(name: str, by: str, size: int, seeds: int, context: Context) -> Iterator[Image]:
    """Denoised pictures of a scene, by as many seeds."""
    options: dict[str, Any] = {"width": size, "height": size, "samples": SAMPLES, "denoise": by}
    renderer = Renderer(load(name), None, context, "complete", **options)
    for seed in range(seeds):
        renderer.update(seed=seed)
        yield renderer.render().image()
    renderer.release()


def judged(name: str, images: Iterator[Image], truth: Truth) -> Found:
    """Errors, their estimates, and harm by blocks: more than chance over the seeds."""
    errors, told, harm = [], [], []
    for image in images:
        shown = image.denoised()
        errors.append([truth.relative(image.radiance), truth.relative(shown.radiance)])
        told.append(shown.error)
        more = truth.squares(shown.radiance) - truth.squares(image.radiance)
        harm.append(blocks_of(more))
    plain, denoised = np.sqrt(np.maximum(np.mean(errors, axis=0), 0))
    estimate = math.sqrt(float(np.mean(np.square(told))))
    spread = float(np.std(told, ddof=1)) / denoised
    worse = certain(np.array(harm))
    return Found(name, plain, denoised, estimate, spread, worse.size, int(worse.sum()))


def blocks_of(squares: Floats) -> Floats:
    """Means over whole blocks, or over the picture where it is smaller."""
    size = min(BLOCK, *squares.shape[:2])
    rows, columns = (length // size for length in squares.shape[:2])
    whole = squares[: rows * size, : columns * size].mean(axis=-1)
    return np.asarray(whole.reshape(rows, size, columns, size).mean(axis=(1, 3)))


def certain(harm: Floats) -> NDArray[np.bool_]:
    """Blocks, the last axes, whose mean over the first axis is above 0 by more than chance."""
    stderr = harm.std(axis=0, ddof=1) / math.sqrt(len(harm))
    return np.asarray(harm.mean(axis=0) > SIGMAS * stderr)


def report(found: Sequence[Found]) -> str:
    """The table as Markdown, and whether the gate is passed."""
    lines = [HEAD, ["---"] * len(HEAD), *(one.row for one in found)]
    table = "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
    gains = sum(one.gain >= 2.5 for one in found)
    right = sum(abs(one.estimate / one.denoised - 1) <= 0.25 for one in found)
    worse, blocks = (sum(getattr(one, name) for one in found) for name in ("worse", "blocks"))
    return (
        f"{table}\n\nAt least 2.5 times less error: {gains} of {len(found)} scenes. Estimate "
        f"within 25 % of the truth: {right} of {len(found)}. Blocks of {BLOCK} x {BLOCK} pixels "
        f"that are worse than plain: {worse} of {blocks}, {100 * worse / blocks:.1f} %.\n"
    )


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.denoised`; returns the exit code."""
    parser = parser_of("denoised", __doc__)
    parser.add_argument("scenes", nargs="*", default=SCENES, metavar="SCENE")
    parser.add_argument("--size", type=at_least(16), default=96, metavar="N", help="pixels a side")
    parser.add_argument("--seeds", type=at_least(2), default=16, metavar="N")
    parser.add_argument("--truth", type=at_least(2), default=16384, metavar="N", help="samples")
    parser.add_argument("--truths", type=Path, metavar="DIR", help="keep truths in this folder")
    parser.add_argument("--by", choices=[*FILTERS], nargs="+", default=[*FILTERS])
    given = parser.parse_args(arguments)
    return exit_code_of(lambda: _run(given))


def _run(given: argparse.Namespace) -> None:
    for by in given.by:
        with_filter(Settings(denoise=by))
    context = open_context()
    print(f"{machine(context.renderer)}; {given.size} x {given.size} pixels, {SAMPLES} samples, ")
    print(f"{given.seeds} seeds; truth from {given.truth} samples.")
    for by in given.by:
        found = []
        for name in given.scenes:
            caustics = "on" if name in BY_PARTICLES else "off"
            ways: Any = {"size": given.size, "samples": given.truth, "caustics": caustics}
            truth = truth_of(name, context, given.truths, **ways)
            images = pictures(name, by, given.size, given.seeds, context)
            found.append(judged(name, images, truth))
            print(f"{by} {' '.join(found[-1].row)}", file=sys.stderr, flush=True)
        print(f"\n{by}:\n\n{report(found)}")
    context.gl.release()


if __name__ == "__main__":
    sys.exit(main())
