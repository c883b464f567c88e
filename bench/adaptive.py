"""Error of pictures whose pixels have counts of their own, over that by equal counts.

`python -m bench.adaptive SCENE...` renders each scene with `--adaptive on` and off, by the same
seeds and with as many samples on average, and prints a row for each: both errors, and the ratio of
their squares, which is how many times the samples equal counts take. The error of a way is the
spread of its pictures by several seeds, so no truth is needed. No time is measured. `--seconds`
compares in equal time instead: both get so many seconds, in turns. `-o FILE.jpg` writes the picture
of docs for the first scene: the picture, and its counts.
"""

import argparse
import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bench.program import add_rounds, at_least, exit_code_of, machine, parser_of
from bench.sheets import in_rows, titled, write_sheet
from glrt.core.files import check_writable
from glrt.error.estimate import relative_error
from glrt.gpu.context import Context, open_context
from glrt.image.image import Image
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.settings import Adaptive

SCENES = ("sky", "weekend", "lens", "cornell", "methods/glass")
WAYS: tuple[Adaptive, ...] = ("off", "on")
Pixels = NDArray[np.float64]


class Row(NamedTuple):
    """The errors of one scene, relative RMS over all seeds, by equal counts and own ones."""

    equal: float
    own: float
    image: Image  # with own counts

    @property
    def gain(self) -> float:
        """Ratio of the squared errors."""
        return (self.equal / self.own) ** 2


def main(arguments: list[str] | None = None) -> int:
    """Print the table and write the picture; returns the exit code."""
    parser = parser_of("adaptive", __doc__)
    parser.add_argument("scenes", nargs="*", default=SCENES, help=f"default: {', '.join(SCENES)}")
    add_rounds(parser, size=128, rounds=4)
    parser.add_argument("--samples", type=at_least(64), default=256, help="default: 256")
    parser.add_argument("--seconds", type=float, help="compare in equal time")
    parser.add_argument("-o", dest="file", type=Path, metavar="FILE.jpg", help="picture to write")
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    if parsed.file:
        check_writable(parsed.file)
    context = open_context()
    print("| scene | error, equal counts | error, own counts | squared, over | counts |")
    print("|---|---|---|---|---|")
    for number, name in enumerate(parsed.scenes):
        row = measure(context, name, parsed)
        counts = row.image.counts
        span = f"{counts.min()} to {counts.max()}"
        print(
            f"| `{name}` | {row.equal:.4f} | {row.own:.4f} | {row.gain:.2f} | {span} |", flush=True
        )
        if parsed.file and not number:
            write_sheet(parsed.file, sheet_of(name, row.image))
    limit = f"{parsed.seconds:g} s" if parsed.seconds else f"{parsed.samples} samples"
    print(f"\n{machine(context.renderer)}; {parsed.size} x {parsed.size}, {limit}")


def measure(context: Context, name: str, asked: argparse.Namespace) -> Row:
    """Render a scene both ways; every round has a seed of its own."""
    scene = load(name)
    size: dict[str, Any] = {"width": asked.size, "height": asked.size, "context": context}
    opened = {way: Renderer(scene, tier="complete", adaptive=way, **size) for way in WAYS}
    radiance: dict[str, list[Pixels]] = {way: [] for way in WAYS}
    images: dict[str, Image] = {}
    for seed in range(1, asked.rounds + 1):
        for way, renderer in opened.items():
            renderer.update(seed=seed)
            images[way] = _rendered(renderer, asked)
            radiance[way].append(images[way].radiance.astype(np.float64))
    for renderer in opened.values():
        renderer.release()
    level = np.mean([np.mean(radiance[way], axis=0) for way in WAYS], axis=0)
    errors = {way: _error(level, np.array(radiance[way])) for way in WAYS}
    return Row(errors["off"], errors["on"], images["on"])


def _error(level: Pixels, pictures: Pixels) -> float:
    """Relative RMS error of one picture from the spread of several (seeds, H, W, 3)."""
    spread = np.std(pictures, axis=0, ddof=1)
    return relative_error(level, spread) or 0.0


def _rendered(renderer: Renderer, asked: argparse.Namespace) -> Image:
    """A picture of so many samples, or of so many seconds."""
    if not asked.seconds:
        return renderer.render(asked.samples).image()
    end = time.perf_counter() + asked.seconds
    return renderer.render(1 << 20, lambda _: time.perf_counter() < end).image()


def sheet_of(name: str, image: Image) -> NDArray[np.uint8]:
    """The picture, and its counts in grey: white has the most samples."""
    counts = image.counts.astype(np.float32)
    grey = np.repeat((counts / counts.max())[..., None], 3, axis=2)
    title = f"samples: {counts.min():.0f} (dark) to {counts.max():.0f} (light)"
    return in_rows([titled(name, image.radiance), titled(title, grey)], 2)


if __name__ == "__main__":
    sys.exit(main())
