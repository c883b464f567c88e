"""Noise of `--sampler net` over that of `sobol` at equal samples, and whether its error is right.

For each scene and number of samples, over renders with different seeds: the variance of a pixel
with nets over that with blocks of 16; estimated over true error; shares of pixels within the
intervals of 68 and 95 % (Student's, of 7 degrees of freedom); and the distance of both mean
pictures in standard errors. A render goes through all numbers of samples. Variances are relative to
the radiance as in `glrt.error.estimate`; the truth is the mean of all longest renders, so that the
shares of the longest are a little too high. No time is measured.
"""

import argparse
import sys
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from bench.mesh_sizes import displaced
from bench.mesh_sizes import scene_of as under_a_sky
from bench.program import at_least, exit_code_of, machine, parser_of
from glrt.error.estimate import DARK
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh

MESH = "mesh"  # a ball of 5,120 triangles under a gradient sky
SCENES = ("cornell", MESH, "lens")
SAMPLES = (16, 32, 64, 256, 1024)
STUDENT_68, STUDENT_95 = 1.0767, 2.3646  # standard errors, for 7 degrees of freedom

Array = np.ndarray[Any, np.dtype[np.float64]]


class Pictures(NamedTuple):
    """Renders of one sampler at one number of samples, (renders, H, W, 3) each."""

    radiance: Array
    stderr: Array


class Row(NamedTuple):
    """The figures of one scene at one number of samples."""

    variance: float  # with nets over that with blocks
    stderr: float  # of that ratio, over halves of the renders and blocks of pixels
    told: float  # estimated over true error of nets
    within: tuple[float, float]  # shares of pixels within their intervals of 68 and 95 %
    apart: float  # root mean square over pixels of the distance of mean pictures, standard errors

    def __str__(self) -> str:
        shares = " | ".join(f"{100 * share:.1f} %" for share in self.within)
        ratio = f"{self.variance:.3f} +- {self.stderr:.3f}"
        return f"{ratio} | {self.told:.3f} | {shares} | {self.apart:.3f}"


def scene_of(name: str) -> Scene:
    """The mesh under a sky, or a scene by its name."""
    if name == MESH:
        return under_a_sky(Mesh(*displaced(4), material="clay", smooth=False))
    return load(name)


def pictures_of(renderer: Renderer, samples: Sequence[int], renders: int) -> list[Pictures]:
    """Renders with the seeds 1 to `renders`, for each of the ascending `samples`."""
    found: list[tuple[list[Any], list[Any]]] = [([], []) for _ in samples]
    for seed in range(1, renders + 1):
        renderer.update(seed=seed)
        for count, (radiance, stderr) in zip(samples, found, strict=True):
            image = renderer.render(count).image()
            radiance.append(image.radiance.astype(np.float64))
            stderr.append(image.stderr.astype(np.float64))
    return [Pictures(np.array(radiance), np.array(stderr)) for radiance, stderr in found]


def judged(net: Pictures, blocks: Pictures, truth: Array) -> Row:
    """The figures of nets against blocks; `truth` is (H, W, 3)."""
    level = np.square(truth) + DARK * truth.mean() ** 2
    own, other = (it.radiance.var(axis=0, ddof=1) / level for it in (net, blocks))
    ratio = float(own.mean() / other.mean())
    away = np.abs(net.radiance - truth)
    within = [float((away <= k * net.stderr).mean()) for k in (STUDENT_68, STUDENT_95)]
    told = np.sqrt((np.square(net.stderr) / level).mean() / own.mean())
    renders = len(net.radiance)
    between = net.radiance.mean(axis=0) - blocks.radiance.mean(axis=0)
    noise = (net.radiance.var(axis=0, ddof=1) + blocks.radiance.var(axis=0, ddof=1)) / renders
    lit = noise > 0
    apart = np.sqrt((np.square(between[lit]) / noise[lit]).mean())
    return Row(
        ratio, _spread(net, blocks, level), float(told), (within[0], within[1]), float(apart)
    )


def _spread(net: Pictures, blocks: Pictures, level: Array) -> float:
    """Standard error of the ratio of variances, by leaving out one render of each in turn."""
    sides = [it.radiance for it in (net, blocks)]
    squares = [np.square(side - side.mean(axis=0)) / level for side in sides]
    each = [square.mean(axis=(1, 2, 3)) for square in squares]
    count = len(each[0])
    ratios = [(each[0].sum() - a) / (each[1].sum() - b) for a, b in zip(*each, strict=True)]
    return float(np.sqrt((count - 1) * np.var(ratios)))


def measure(
    context: Context, name: str, samples: Sequence[int], size: int, renders: int
) -> list[Row]:
    """A row for each of the ascending `samples`, for a scene at `size` x `size` pixels."""
    options: dict[str, Any] = {"width": size, "height": size, "caustics": "off"}
    found = []
    for sampler in ("net", "sobol"):
        scene = scene_of(name)
        renderer = Renderer(scene, context=context, tier="complete", sampler=sampler, **options)
        try:
            found.append(pictures_of(renderer, samples, renders))
        finally:
            renderer.release()
    net, blocks = found
    truth = (net[-1].radiance.mean(axis=0) + blocks[-1].radiance.mean(axis=0)) / 2
    return [judged(own, other, truth) for own, other in zip(net, blocks, strict=True)]


def table(found: dict[str, list[Row]], samples: Sequence[int]) -> Iterator[str]:
    """A row for each scene and number of samples, as Markdown."""
    heads = "variance, net over sobol | estimate over truth | 68 % | 95 % | means apart"
    yield f"| scene | samples | {heads} |"
    yield "|---|---|---|---|---|---|---|"
    for name, rows in found.items():
        yield from (f"| {name} | {n} | {row} |" for n, row in zip(samples, rows, strict=True))


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.nets`; returns the exit code."""
    parser = parser_of("nets", __doc__)
    add = parser.add_argument
    add("--scenes", nargs="+", metavar="NAME", default=SCENES)
    add("--samples", nargs="+", type=at_least(2), metavar="N", default=SAMPLES)
    add("--size", type=at_least(1), default=24, metavar="N", help="pixels a side (default: 24)")
    add("--renders", type=at_least(3), default=48, metavar="N", help="by sampler (default: 48)")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> None:
    context = open_context()
    samples = sorted(parsed.samples)
    print(f"{machine(context.renderer)}, {parsed.size} x {parsed.size} pixels\n")
    found = {}
    for name in parsed.scenes:
        print(f"{name} ...", file=sys.stderr)
        found[name] = measure(context, name, samples, parsed.size, parsed.renders)
    print("\n".join(table(found, samples)))


if __name__ == "__main__":
    sys.exit(main())
