"""Gain of a sampler, by default of numbers that pixels share (--sampler shared), over `sobol`.

For each scene, pictures by both samplers are rendered in turns. The columns are: the squared error
of `sobol` over that of the other at equal samples, from the spread over seeds; the time of `sobol`
over that of the other, which includes finding the weights of `shared` (medians); the product of
both, which is the gain in equal time; the error that pictures by the other estimate, over the true
one, with the quantiles of 5 and 95 % over seeds; and how far the means of both over all seeds are
apart, in standard errors, RMS over blocks of 8 x 8 pixels: 1 for equal means. `-o FILE.jpg` writes
pictures of the first scene.
"""

import argparse
import sys
import time
from pathlib import Path
from typing import Any, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from bench.mesh_sizes import displaced
from bench.mesh_sizes import scene_of as under_a_sky
from bench.program import add_rounds, at_least, exit_code_of, machine, parser_of
from bench.sheets import in_rows, titled, write_sheet
from glrt.core.files import check_writable
from glrt.error.estimate import DARK, block_means
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.samplers import DIVISIONS
from glrt.scene.scene import Scene
from glrt.scene.shapes.mesh import Mesh
from glrt.settings import Caustics, Sampler

MESH = "mesh"  # a ball of 5,120 triangles under a gradient sky
SCENES = ("cornell", "sky", "metals", "weekend", "methods/diffuse", MESH)
QUANTILES = (0.05, 0.95)
BLOCK = 8  # pixels a side, of means
OTHER_SEEDS = 1 << 20  # samplers must not share numbers
BASE: Sampler = "sobol"
OTHERS = tuple(it for it in get_args(Sampler) if it != BASE)

Array = NDArray[np.float64]


class Gain(NamedTuple):
    """The figures of a scene."""

    variance: float  # squared error of sobol over that of the other, at equal samples
    speed: float  # time of sobol over that of the other
    told: float  # estimated over true error of the other, root mean square over seeds
    ends: tuple[float, float]  # QUANTILES of that over seeds
    apart: float  # RMS over blocks of how far the means are apart, in standard errors

    def __str__(self) -> str:
        """Columns of the table."""
        figures = f"{self.variance:.2f} | {self.speed:.2f} | {self.variance * self.speed:.2f}"
        told = f"{self.told:.2f} ({self.ends[0]:.2f} to {self.ends[1]:.2f})"
        return f"{figures} | {told} | {self.apart:.2f}"


def scene_of(name: str) -> Scene:
    """The mesh under a sky, or a scene by its name."""
    if name == MESH:
        return under_a_sky(Mesh(*displaced(4), material="clay", smooth=False))
    return load(name)


def measure(
    context: Context, name: str, asked: argparse.Namespace
) -> tuple[Gain, list[NDArray[np.float32]]]:
    """The figures of a scene, and its pictures of the first seed."""
    size: dict[str, Any] = {"width": asked.size, "height": asked.size, "caustics": asked.caustics}
    scene = scene_of(name)
    samplers: tuple[Sampler, ...] = (BASE, asked.sampler)
    opened = {
        it: Renderer(scene, context=context, tier="complete", sampler=it, **size) for it in samplers
    }
    images: dict[str, list[Image]] = {it: [] for it in samplers}
    seconds: dict[str, list[float]] = {it: [] for it in samplers}
    try:
        for seed in range(asked.rounds):
            for number, (sampler, renderer) in enumerate(opened.items()):
                renderer.update(seed=seed + number * OTHER_SEEDS)
                start = time.perf_counter()
                images[sampler].append(renderer.render(asked.samples).image())
                seconds[sampler].append(time.perf_counter() - start)
    finally:
        for renderer in opened.values():
            renderer.release()
    plain, other = (images[it] for it in samplers)
    medians = [float(np.median(seconds[it])) for it in samplers]
    return judged(plain, other, medians[0] / medians[1]), [plain[0].radiance, other[0].radiance]


def judged(plain: list[Image], other: list[Image], speed: float) -> Gain:
    """The figures of pictures by several seeds."""
    means = [np.array([it.radiance for it in images], float) for images in (plain, other)]
    level = np.square(means[0].mean(axis=0)) + DARK * means[0].mean() ** 2
    base, true = (float((it.var(axis=0, ddof=1) / level).mean()) for it in means)
    told = np.array([(np.square(it.stderr, dtype=float) / level).mean() for it in other])
    low, high = np.sqrt(np.quantile(told, QUANTILES) / true)
    ends = float(low), float(high)
    return Gain(base / true, speed, float(np.sqrt(told.mean() / true)), ends, _apart(*means))


def _apart(plain: Array, other: Array) -> float:
    """How far the means over seeds are apart, (seeds, H, W, 3) each; 0 for small pictures."""
    if min(plain.shape[1:3]) < BLOCK:
        return 0.0
    blocks = [np.array([block_means(it, BLOCK) for it in some]) for some in (plain, other)]
    error = sum(it.var(axis=0, ddof=1) / len(it) for it in blocks)
    apart = blocks[1].mean(axis=0) - blocks[0].mean(axis=0)
    scores = np.square(apart) / np.where(error > 0, error, np.inf)
    return float(np.sqrt(scores[error > 0].mean()))


def main(arguments: list[str] | None = None) -> int:
    """Print the table and write the pictures; returns the exit code."""
    parser = parser_of("shared", __doc__)
    parser.add_argument("scenes", nargs="*", default=SCENES, help=f"default: {', '.join(SCENES)}")
    add_rounds(parser, size=96, rounds=16)
    least = DIVISIONS["shared"].block
    parser.add_argument("--samples", type=at_least(least), default=least, help=f"default: {least}")
    particles = "particles from lamps (default: off)"
    parser.add_argument("--caustics", choices=get_args(Caustics), default="off", help=particles)
    told = "the other sampler (default: shared)"
    parser.add_argument("--sampler", choices=OTHERS, default="shared", help=told)
    parser.add_argument("-o", dest="file", type=Path, metavar="FILE.jpg", help="picture to write")
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    if parsed.file:
        check_writable(parsed.file)
    context = open_context()
    print("| scene | equal samples | speed | equal time | estimated over true error | means |")
    print("|---|---|---|---|---|---|")
    for number, name in enumerate(parsed.scenes):
        gain, pictures = measure(context, name, parsed)
        print(f"| `{name}` | {gain} |", flush=True)
        if parsed.file and not number:
            names = BASE, parsed.sampler
            shown = [titled(it, picture) for it, picture in zip(names, pictures, strict=True)]
            write_sheet(parsed.file, in_rows(shown, len(shown)))
    about = f"{parsed.size} x {parsed.size}, {parsed.samples} samples, {parsed.rounds} seeds"
    print(f"\n{machine(context.renderer)}; {about}")


if __name__ == "__main__":
    sys.exit(main())
