"""The estimated error of pictures over the true one, under fireflies and in ordinary scenes.

`python -m bench.error_ratios` prints the table of docs/explanation/error.md: for each scene the
true relative RMS error of its pictures, root mean square over seeds, and over it the estimate: by
the own radiance of each pixel, and by `glrt.error.estimate.estimated_error`. Each column has the
root mean square over seeds, and the quantiles at 10, 50 and 90 %. Truth is the product of the
distances to two halves of other seeds by `mis`. Scenes are of 48 x 36 pixels.
"""

import argparse
import math
import sys
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from bench.doubt import HALF_SEEDS, SIZE
from bench.fooling_scenes import KINDS, fooling_scene, metal_balls
from bench.program import at_least, exit_code_of, machine, parser_of
from glrt.error.estimate import DARK, estimated_error, relative_error
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.lab.noisy_scenes import CASES
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Method, Sampler

ORDINARY = ("cornell", "lamps", "lens", "metals", "sky", "weekend")
FIRST = 101  # seed of the first scene of each kind of bench/fooling_scenes.py
HALF = 2048  # samples of a half of the truth
BOUNCES = 6  # at most
QUANTILES = (0.1, 0.5, 0.9)

Array = NDArray[np.float64]


class Ratios(NamedTuple):
    """The true errors of the pictures of a scene, and the ratios of estimates, (seeds,) each."""

    true: float
    by_own: Array
    estimated: Array


def scenes(count: int) -> Iterator[tuple[str, Scene, Method]]:
    """Ordinary scenes, and so many of each kind where few samples find light."""
    yield from ((name, load(name), "mis") for name in ORDINARY)
    yield "caustic", CASES["caustic"].scene, "mis"
    yield "metal balls by nee", metal_balls(0.15), "nee"
    for kind in KINDS:
        for seed in range(FIRST, FIRST + count):
            yield f"{kind} {seed}", *fooling_scene(kind, seed)


def ratios_of(
    scene: Scene, method: Method, context: Context, samples: int, seeds: int, sampler: Sampler
) -> Ratios:
    """The estimates of pictures of the seeds 1 to `seeds`, over their true error."""
    size: dict[str, Any] = {**SIZE, "bounces": min(BOUNCES, scene.render.bounces)}
    truth = Renderer(scene, context=context, method="mis", **size)
    halves = []
    for seed in HALF_SEEDS:
        truth.update(seed=seed)
        halves.append(truth.render(HALF).image().radiance.astype(np.float64))
    truth.release()
    first, second = halves
    level = (first + second) / 2
    scale = np.square(level) + DARK * level.mean() ** 2
    renderer = Renderer(scene, context=context, method=method, sampler=sampler, **size)
    squares, by_own, estimated = [], [], []
    for seed in range(1, seeds + 1):
        renderer.update(seed=seed)
        image = renderer.render(samples).image()
        squares.append(float(((image.radiance - first) * (image.radiance - second) / scale).mean()))
        by_own.append(relative_error(image.radiance, image.stderr) or 0.0)
        estimated.append(estimated_error(image.radiance, image.stderr) or 0.0)
    renderer.release()
    true = math.sqrt(max(float(np.mean(squares)), 1e-300))
    return Ratios(true, np.array(by_own) / true, np.array(estimated) / true)


def row(name: str, found: Ratios) -> str:
    """Rows of the table, as Markdown."""
    return f"| {name} | {found.true:.3f} | {_told(found.by_own)} | {_told(found.estimated)} |"


def _told(ratios: Array) -> str:
    low, middle, high = np.quantile(ratios, QUANTILES)
    return f"{math.sqrt(np.square(ratios).mean()):.2f} ({low:.2f}, {middle:.2f}, {high:.2f})"


def main(arguments: Sequence[str] | None = None) -> int:
    """`python -m bench.error_ratios`; returns the exit code."""
    parser = parser_of("error_ratios", __doc__)
    add = parser.add_argument
    add("--samples", type=at_least(2), default=64, metavar="N")
    add("--seeds", type=at_least(1), default=24, metavar="N")
    add("--kinds", type=at_least(0), default=2, metavar="N", help="scenes of each kind")
    add("--sampler", choices=get_args(Sampler), default="sobol")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> None:
    context = open_context()
    how = f"{parsed.samples} samples, {parsed.seeds} seeds, {parsed.sampler}"
    print(f"{machine(context.renderer)}, {SIZE['width']} x {SIZE['height']} pixels, {how}\n")
    print("| scene | true error | by own radiance | estimate |\n|---|---|---|---|")
    for name, scene, method in scenes(parsed.kinds):
        found = ratios_of(scene, method, context, parsed.samples, parsed.seeds, parsed.sampler)
        print(row(name, found), flush=True)


if __name__ == "__main__":
    sys.exit(main())
