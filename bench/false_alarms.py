"""Rates of false alarms and of detections of `glrt compare`.

`python -m bench.false_alarms` prints the tables of docs/results/compare.md. A picture of 256 or
4,096 samples is averaged from independent ones of 64. Pairs share no renders, except that there are
only as many pictures of 4,096 samples as there are sets of 64 renders, which pairs use in turn.
"""

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.program import add_tables, exit_code_of, machine, parser_of
from glrt.comparison.result import Comparison, percent
from glrt.comparison.verdict import compare
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image
from glrt.image.recipe import Recipe
from glrt.lab.noisy_scenes import CASES, FOUND, OTHERS, PLANTED, SOBOL, Case
from glrt.rendering.renderer import Renderer

Floats = NDArray[np.float32]
Change = Callable[[Image], Image]

SIZE = 48  # pixels on a side
ALPHA = 0.01  # significance level
LARGE = 4096  # samples of a picture with little noise
FINDS = ((64, 64), (64, LARGE), (1024, 1024))  # samples of image and reference


@dataclass(frozen=True)
class Pool:
    """Independent renders: mean, and variance of an observation, (renders, H, W, 3) each."""

    means: Floats
    variances: Floats
    samples: int  # per pixel, of each render
    block: int = 1  # samples of an observation
    recipe: Recipe | None = None  # of one of the renders

    def part(self, first: int, end: int | None = None) -> "Pool":
        """The renders from `first` to before `end`."""
        return replace(self, means=self.means[first:end], variances=self.variances[first:end])

    def pictures(self, samples: int) -> int:
        """The number of independent pictures with this many samples."""
        return len(self.means) // (samples // self.samples)

    def picture(self, index: int, samples: int) -> Image:
        """A picture with this many samples; pictures of different indices share no render."""
        group = samples // self.samples
        means = self.means[index * group : (index + 1) * group].astype(np.float64)
        inner = self.variances[index * group : (index + 1) * group].mean(axis=0, dtype=np.float64)
        variance = (inner + means.var(axis=0)) / (samples // self.block - 1)
        mean, stderr = (array.astype(np.float32) for array in (means.mean(axis=0), variance**0.5))
        return Image(mean, stderr, samples, self.recipe)


def gather(context: Context, case: Case, samples: int, renders: int, seed: int) -> Pool:
    """A pool of renders of a case with the seeds `seed` to `seed` + `renders` - 1."""
    settings: dict[str, Any] = {
        "width": SIZE,
        "height": SIZE,
        "bounces": case.bounces,
        "method": case.method,
        "sampler": case.sampler,
    }
    renderer = Renderer(case.scene, context=context, **settings)
    means, variances = (np.empty((renders, SIZE, SIZE, 3), np.float32) for _ in range(2))
    block = renderer.settings.block
    for i in range(renders):
        renderer.update(seed=seed + i)
        image = renderer.render(samples).image()
        means[i], variances[i] = image.radiance, np.square(image.stderr) * (samples // block - 1)
    renderer.release()
    return Pool(means, variances, samples, block, image.recipe)


def compared(
    images: Pool,
    references: Pool,
    samples: tuple[int, int],
    alike: bool | None = True,
    change: Change = lambda image: image,
) -> list[Comparison]:
    """Compare every image with a reference; references are reused in turn if there are fewer."""
    have = [pool.pictures(n) for pool, n in zip((images, references), samples, strict=True)]
    found = []
    for i in range(have[0]):
        image = change(images.picture(i, samples[0]))
        found.append(
            compare(image, references.picture(i % have[1], samples[1]), ALPHA, alike=alike)
        )
    return found


def brighter(factor: float) -> Change:
    """A change that multiplies the radiance and its standard error."""
    scale = np.float32(factor)
    return lambda image: replace(
        image, radiance=image.radiance * scale, stderr=image.stderr * scale
    )


def wrong_pixel(factor: float) -> Change:
    """A change that multiplies the radiance of one pixel in the middle of the floor."""

    def change(image: Image) -> Image:
        radiance = image.radiance.copy()
        radiance[44, 24] *= factor
        return replace(image, radiance=radiance)

    return change


def without_errors(image: Image) -> Image:
    """A picture without standard errors, as read from an NPY file."""
    return replace(image, stderr=np.full_like(image.stderr, np.nan))


CHANGES: dict[str, Change] = {
    "nothing": lambda image: image,
    "0.1 % brighter": brighter(1.001),
    "1 % brighter": brighter(1.01),
    "one pixel of the floor x 1.5": wrong_pixel(1.5),
    "one pixel of the floor x 3": wrong_pixel(3),
    "one pixel of the floor NaN": wrong_pixel(float("nan")),
}


class Experiment:
    """The rows of all tables; renders that several tables use are made once."""

    def __init__(self, context: Context, count: int) -> None:
        """With `count` pairs of equal pictures, and a tenth of that for each kind of difference."""
        self._context = context
        self.count = count
        self.tenth = max(count // 10, 1)
        self._seeds = iter(range(0, 1 << 32, 1 << 20))

    def _gathered(self, cases: dict[str, Case], samples: int, renders: int) -> dict[str, Pool]:
        return {
            name: gather(self._context, case, samples, renders, next(self._seeds))
            for name, case in cases.items()
        }

    @cached_property
    def _pools(self) -> dict[str, Pool]:
        return self._gathered(CASES, 64, 4 * self.count + LARGE // 64)

    def equal(self) -> list[list[str]]:
        """Rows of equal pictures: scene, methods, then `_tally`, for each pair of sample counts."""
        rows = []
        of_16 = self._gathered(CASES, 16, self.count)
        others = self._gathered(OTHERS, 64, self.count)
        for name, pool in self._pools.items():
            images, rest = pool.part(0, self.count), pool.part(self.count)
            few = of_16[name]
            mixes = (((16, 256), few, pool), ((64, 64), images, rest), ((64, LARGE), images, rest))
            for samples, a, b in mixes:
                rows.append([name, "same", *_tally(samples, compared(a, b, samples))])
            for samples, a, b in mixes:
                found = compared(a, b, samples, None, without_errors)
                rows.append([name, "same, image without errors", *_tally(samples, found)])
            methods = f"{OTHERS[name].method} against {CASES[name].method}"
            for samples in ((64, 64), (64, LARGE)):
                found = compared(others[name], rest, samples, None)
                rows.append([name, methods, *_tally(samples, found)])
        return rows

    def sobol(self) -> list[list[str]]:
        """The same with Sobol' points, whose standard errors are over blocks of 16 samples."""
        rows = []
        independent = {name: CASES[name] for name in SOBOL}
        others = {name: replace(OTHERS[name], sampler="sobol") for name in SOBOL}
        pools = self._gathered(SOBOL, 64, 2 * self.count + LARGE // 64)
        few = self._gathered(SOBOL, 32, self.count)
        by_chance = self._gathered(independent, 64, self.count)
        by_other = self._gathered(others, 64, self.count)
        for name, pool in pools.items():
            images, rest = pool.part(0, self.count), pool.part(self.count)
            methods = f"{others[name].method} against {SOBOL[name].method}"
            mixes: list[tuple[str, tuple[int, int], Pool, bool | None, Change]] = [
                ("same", (32, 64), few[name], True, _unchanged),
                ("same", (64, 64), images, True, _unchanged),
                ("same", (64, LARGE), images, True, _unchanged),
                ("same, image without errors", (64, 64), images, None, without_errors),
                ("same, image of independent numbers", (64, 64), by_chance[name], None, _unchanged),
                (methods, (64, 64), by_other[name], None, _unchanged),
            ]
            for what, samples, a, alike, change in mixes:
                found = compared(a, rest, samples, alike, change)
                rows.append([name, what, *_tally(samples, found)])
        return rows

    def different(self) -> list[list[str]]:
        """Rows of different pictures: scene, difference, and share detected for each of FINDS."""
        rows = []
        lamp = {name: case for name, case in FOUND.items() if name not in CASES}
        pools = {**self._pools, **self._gathered(lamp, 64, 32 * self.tenth + LARGE // 64)}
        planted = {k: self._gathered(cases, 64, 16 * self.tenth) for k, cases in PLANTED.items()}
        for name, pool in pools.items():
            images, rest = pool.part(0, 16 * self.tenth), pool.part(16 * self.tenth)
            kinds = [(what, images, change) for what, change in CHANGES.items()]
            kinds += [(what, cases[name], _unchanged) for what, cases in planted.items()]
            for what, a, change in kinds:
                rows.append([name, what])
                for samples in FINDS:
                    found = compared(
                        a.part(0, self.tenth * samples[0] // 64), rest, samples, True, change
                    )
                    rows[-1].append(f"{100 * _share(found):.0f} %")
        return rows


def _unchanged(image: Image) -> Image:
    return image


def _share(found: list[Comparison]) -> float:
    return sum(not comparison for comparison in found) / len(found)


def _tally(samples: tuple[int, int], found: list[Comparison]) -> list[str]:
    """Samples, false alarms with their 95 % interval, median of the change of all light found."""
    alarms = sum(not comparison for comparison in found)
    low, high = wilson(alarms, len(found))
    shown = float(np.median([comparison.sensitivity.light for comparison in found]))
    return [
        f"{samples[0]} / {samples[1]}",
        f"{alarms} of {len(found)}",
        f"{100 * low:.1f} to {100 * high:.1f} %",
        percent(shown),
    ]


def wilson(hits: int, trials: int, z: float = 1.96) -> tuple[float, float]:
    """The score interval of a proportion (Wilson 1927)."""
    share, narrow = hits / trials, z * z / trials
    middle = (share + narrow / 2) / (1 + narrow)
    half = z / (1 + narrow) * math.sqrt(share * (1 - share) / trials + narrow / (4 * trials))
    return max(middle - half, 0), min(middle + half, 1)


def markdown(head: list[str], rows: list[list[str]]) -> str:
    """A table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


ALARMS = [
    *("scene", "methods", "samples", "called different", "95 % interval"),
    "change found",
]
TABLES = {
    "equal": (ALARMS, Experiment.equal),
    "sobol": (ALARMS, Experiment.sobol),
    "different": (
        ["scene", "what differs", *(f"{a} / {b}" for a, b in FINDS)],
        Experiment.different,
    ),
}


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.false_alarms`; returns the exit code."""
    parser = parser_of("false_alarms", __doc__)
    add_tables(parser, TABLES)
    parser.add_argument("--pairs", type=int, default=1000, metavar="N", help="pairs per row")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _print(parsed.tables, parsed.pairs))


def _print(names: Sequence[str], pairs: int) -> None:
    context = open_context()
    experiment = Experiment(context, pairs)
    print(f"{machine(context.renderer)}, {SIZE} x {SIZE} pixels, {pairs} pairs")
    for name in names:
        head, rows_of = TABLES[name]
        print("\n" + markdown(head, rows_of(experiment)), flush=True)


if __name__ == "__main__":
    sys.exit(main())
