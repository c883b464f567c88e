"""Gain of random numbers that pixels share, as a control variate between neighbours.

Half of the samples of a pixel use the same random numbers as in all other pixels (C), half use
their own (P). C and P have the same mean, so any picture (C + P) / 2 + L (C - P) has that mean too,
for each linear map L that does not depend on these samples. Neighbours of C err alike. So C minus
its mean over a box has little noise, and the box of P brings back the mean of both.

Two ways to find L are measured, each by region: the pixels of one object in one tile. `radius`: the
best radius of the box for C - box(C) + box(P), or (C + P) / 2. `weights`: least squares for the
weights of C - P and of its means over three boxes. Both look at one half of the renders for the
picture of the other half, so that the picture stays unbiased.

For each scene: the squared error of a plain picture over that of both ways at equal samples, from
the spread over seeds; and the error that the picture itself estimates over the true one (mean, and
quantiles of 5 and 95 % over seeds). No time is measured. `-o FILE.jpg` writes pictures of the first
scene: plain, and by weights.
"""

import argparse
import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bench.nets import scene_of
from bench.program import add_rounds, at_least, exit_code_of, machine, parser_of
from bench.shader_edits import Edit, edited
from bench.terms import titled, write_sheet
from glrt.core.files import check_writable, write_whole
from glrt.error.estimate import DARK
from glrt.gpu.context import Context, open_context
from glrt.rendering.pipelines import PLAIN
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene

SCENES = ("cornell", "sky", "metals", "weekend", "methods/diffuse", "mesh")
BLOCK = 16  # samples of a block of Sobol' points
RENDERS = 8  # of C, and of P, that a picture consists of
TILE = 32  # pixels a side of a region
RADII = (1, 2, 3, 5, 8)  # pixels, to choose one from
BOXES = (0, 1, 3, 8)  # radii of the boxes that have weights
RIDGE = 1e-3  # of the diagonal: regions without noise have a solution, too
QUANTILES = (0.05, 0.95)
SAMPLER = "Sampler sampler_at(ivec2 pixel, int index, uint seed) {\n"
KERNELS = (
    PLAIN,
    edited(Edit("sampling/sampler.glsl", SAMPLER, SAMPLER + "    pixel = ivec2(0);\n")),
)
WAYS = ("radius", "weights")
OTHER_SEEDS = 1 << 20  # of plain pictures

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]


class Noisy(NamedTuple):
    """A picture, (H, W, 3), and its standard error."""

    radiance: Array
    stderr: Array


class Way(NamedTuple):
    """The figures of one way to find the map."""

    gain: float  # squared error of plain pictures over that of these, equal samples
    told: float  # estimated over true error, root mean square over seeds
    told_ends: tuple[float, float]  # QUANTILES of that over seeds

    def __str__(self) -> str:
        low, high = self.told_ends
        return f"{self.gain:.2f} | {self.told:.3f} ({low:.2f} to {high:.2f})"


def boxes(pictures: Array, radii: Sequence[int], objects: Numbers) -> Array:
    """Means of (..., H, W, C) over squares of pixels of one object (H, W), for ascending radii.

    Squares of 2 radius + 1 pixels a side; the result is (radii, ..., H, W, C).
    """
    height, width = objects.shape
    total, count, found = pictures.copy(), np.ones((height, width, 1)), []
    for radius in range(max(radii) + 1):
        for down, right in _ring(radius):
            own, other = _overlap(height, down), _overlap(height, -down)
            left, moved = _overlap(width, right), _overlap(width, -right)
            same = (objects[own, left] == objects[other, moved])[..., None]
            total[..., own, left, :] += same * pictures[..., other, moved, :]
            count[own, left] += same
        if radius in radii:
            found.append(total / count)
    return np.array(found)


def _ring(radius: int) -> list[tuple[int, int]]:
    """Places of a square's edge about its middle, which has no edge of its own."""
    steps = range(-radius, radius + 1)
    return [(i, j) for i in steps for j in steps if max(abs(i), abs(j)) == radius > 0]


def _overlap(size: int, shift: int) -> slice:
    """The places of a row of `size` whose neighbour at `shift` is in it."""
    return slice(max(0, -shift), max(0, min(size, size - shift)))


def regions_of(objects: Numbers, tile: int = TILE) -> Numbers:
    """The number of each pixel's region, (H, W) from 0: pixels of one object in one tile."""
    row, column = (place // tile for place in np.indices(objects.shape))
    keys = np.stack([objects, row, column], axis=-1).reshape(-1, 3)
    return np.unique(keys, axis=0, return_inverse=True)[1].reshape(objects.shape)


def by_radius(mean: Array, boxed: Array, level: Array, regions: Numbers) -> Array:
    """Weights (regions, 1 + radii) of C - P and its boxes, for the radius with the least variance.

    `mean` is (C + P) / 2 of several renders, (renders, H, W, 3); `boxed` is C - P and its means
    over boxes, (1 + radii, renders, H, W, 3); `level` divides squared errors, (H, W, 1 or 3).
    """
    count = len(boxed)
    ways = np.eye(count) * -1 + np.eye(count)[0] / 2  # (C - P) / 2 - box(C - P)
    ways[0] = 0
    noise = []
    for way in ways:
        spread = (mean + np.tensordot(way, boxed, 1)).var(axis=0, ddof=1)
        noise.append(_sums((spread / level).sum(axis=-1), regions))
    return np.asarray(ways[np.argmin(noise, axis=0)])


def by_weights(mean: Array, boxed: Array, level: Array, regions: Numbers) -> Array:
    """The same by least squares: the weights with the least variance in each region."""
    apart, x = mean - mean.mean(axis=0), boxed - boxed.mean(axis=1, keepdims=True)
    count = len(x)
    matrix = np.empty((regions.max() + 1, count, count))
    wanted = np.empty((regions.max() + 1, count))
    for i in range(count):
        wanted[:, i] = -_sums((x[i] * apart / level).sum(axis=(0, -1)), regions)
        for j in range(i, count):
            both = _sums((x[i] * x[j] / level).sum(axis=(0, -1)), regions)
            matrix[:, i, j] = matrix[:, j, i] = both
    steps = np.arange(count)
    matrix[:, steps, steps] = matrix[:, steps, steps] * (1 + RIDGE) + np.finfo(float).tiny
    return np.asarray(np.linalg.solve(matrix, wanted[..., None])[..., 0])


def _sums(values: Array, regions: Numbers) -> Array:
    return np.bincount(regions.ravel(), values.ravel()).astype(np.float64)


def picture_of(
    common: Array, own: Array, objects: Numbers, way: str, fits_own: bool = False
) -> Noisy:
    """The picture of renders C and P, (renders, H, W, 3) each, and its standard error.

    Renders with even numbers are one half. With `fits_own`, a half finds its own map: biased.
    """
    mean, apart, regions = (common + own) / 2, common - own, regions_of(objects)
    find, radii = (by_radius, (0, *RADII)) if way == "radius" else (by_weights, BOXES)
    boxed = boxes(apart, radii, objects)
    radiance, variance = np.zeros(mean.shape[1:]), np.zeros(mean.shape[1:])
    for half in (0, 1):
        seen = slice(half if fits_own else 1 - half, None, 2)
        level = _level(mean[seen].mean(axis=0))
        weights = find(mean[seen], boxed[:, seen], level, regions)
        used = slice(half, None, 2)
        parts = mean[used] + np.einsum("hwk,knhwc->nhwc", weights[regions], boxed[:, used])
        radiance += parts.mean(axis=0) / 2
        variance += parts.var(axis=0, ddof=1) / len(parts) / 4
    return Noisy(radiance, np.sqrt(variance))


def _level(radiance: Array) -> Array:
    """The level that squared errors are relative to (glrt.error.estimate); 1 for black pictures."""
    level = np.square(radiance) + DARK * radiance.mean() ** 2
    return np.where(level > 0, level, 1)


def measure(
    context: Context, name: str, asked: argparse.Namespace
) -> tuple[list[Way], list[Array]]:
    """The figures of WAYS for a scene, and pictures of the first seed: plain, and by WAYS."""
    scene = scene_of(name)
    size: dict[str, Any] = {"width": asked.size, "height": asked.size, "caustics": "off"}
    objects = _objects(scene, context, size)
    opened = [Renderer(scene, context=context, tier="baked", variant=it, **size) for it in KERNELS]
    plain, found = [], {way: list[Noisy]() for way in WAYS}
    try:
        for number in range(asked.rounds):
            seeds = range(RENDERS * number, RENDERS * (number + 1))
            plain.append(_renders(opened[0], [OTHER_SEEDS + number], asked.samples)[0])
            own, common = (_renders(it, seeds, asked.samples // (2 * RENDERS)) for it in opened)
            for way in WAYS:
                found[way].append(picture_of(common, own, objects, way))
    finally:
        for renderer in opened:
            renderer.release()
    level = _level(np.mean(plain, axis=0))
    base = float((np.var(plain, axis=0, ddof=1) / level).mean())
    firsts = [plain[0], *(pictures[0].radiance for pictures in found.values())]
    return [_judged(pictures, base, level) for pictures in found.values()], firsts


def _renders(renderer: Renderer, seeds: Sequence[int], samples: int) -> Array:
    """Pictures with these seeds, (seeds, H, W, 3)."""
    found = []
    for seed in seeds:
        renderer.update(seed=seed)
        found.append(renderer.render(samples).image().radiance.astype(np.float64))
    return np.array(found)


def _objects(scene: Scene, context: Context, size: dict[str, Any]) -> Numbers:
    """The object in the middle of each pixel, (H, W)."""
    renderer = Renderer(scene, context=context, tier="baked", aov=("object",), **size)
    try:
        found = renderer.render(1).image().aovs["object"].value
    finally:
        renderer.release()
    numbers: Numbers = np.rint(found).astype(np.int64)
    return numbers.reshape(size["height"], size["width"])


def _judged(pictures: list[Noisy], base: float, level: Array) -> Way:
    """The figures of pictures by several seeds; `base`: squared error of plain ones."""
    true = float((np.var([it.radiance for it in pictures], axis=0, ddof=1) / level).mean())
    told = np.array([(np.square(it.stderr) / level).mean() for it in pictures])
    low, high = np.sqrt(np.quantile(told, QUANTILES) / true)
    return Way(base / true, float(np.sqrt(told.mean() / true)), (float(low), float(high)))


def main(arguments: list[str] | None = None) -> int:
    """Print the table and write the pictures; returns the exit code."""
    parser = parser_of("shared", __doc__)
    parser.add_argument("scenes", nargs="*", default=SCENES, help=f"default: {', '.join(SCENES)}")
    add_rounds(parser, size=96, rounds=16)
    least = 2 * RENDERS * BLOCK
    parser.add_argument("--samples", type=at_least(least), default=least, help=f"default: {least}")
    parser.add_argument("-o", dest="file", type=Path, metavar="FILE.jpg", help="picture to write")
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    if parsed.file:
        check_writable(parsed.file)
    context = open_context()
    print("| scene | gain, radius | estimate over truth | gain, weights | estimate over truth |")
    print("|---|---|---|---|---|")
    for number, name in enumerate(parsed.scenes):
        ways, pictures = measure(context, name, parsed)
        print(f"| `{name}` | {' | '.join(map(str, ways))} |", flush=True)
        if parsed.file and not number:
            titles = f"{parsed.samples} samples", "shared, best radius", "shared, weights"
            shown = [titled(title, it) for title, it in zip(titles, pictures, strict=True)]
            write_whole(parsed.file, partial(write_sheet, sheet=np.concatenate(shown, axis=1)))
    about = f"{parsed.size} x {parsed.size}, {parsed.samples} samples, {parsed.rounds} seeds"
    print(f"\n{machine(context.renderer)}; {about}")


if __name__ == "__main__":
    sys.exit(main())
