"""The light that each effect of rays adds to a rasterised picture, and the rays that it costs.

`python -m bench.effects` renders a scene by the method hybrid without effects, then with one more
after the other, and prints a row for each: the mean of the picture, its distance from the reference
by `mis`, and the rays of a sample. All figures are the same on every machine. `-o FILE.jpg` writes
the picture of docs: one for each row, and the reference.
"""

import argparse
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bench.program import add_picture, exit_code_of, parser_of
from bench.sheets import in_rows, titled, write_sheet
from glrt.core.files import check_writable
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.rendering.pipelines import PLAIN, Variant
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import EFFECTS, Effect

COLUMNS = 4  # pictures in a row
COUNTING = Variant({"COUNT_RAYS": True})
DARK = 0.01  # share of the mean below which a pixel's distance is not relative: as for errors

Picture = NDArray[np.float32]


def main(arguments: list[str] | None = None) -> int:
    """Print the table and write the picture; returns the exit code."""
    parser = parser_of("effects", __doc__)
    add_picture(parser, "cornell", 256, 192, "edge, pixels")
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    if parsed.file:
        check_writable(parsed.file)
    context, scene = open_context(), load(parsed.scene)
    size: dict[str, Any] = {"width": parsed.size, "height": parsed.size}
    truth = _rendered(context, scene, parsed.samples, method="mis", **size)
    print("| effects | mean | distance from `mis` | rays of a sample |")
    print("|---|---|---|---|")
    cells = []
    for title, effects in steps():
        way = {**size, "method": "hybrid", "effects": effects}
        found = _rendered(context, scene, parsed.samples, **way)
        rays = _rendered(context, scene, 16, COUNTING, **way).mean(dtype=np.float64)
        mean, away = found.mean(dtype=np.float64), distance(found, truth)
        print(f"| {title} | {mean:.4f} | {away:.3f} | {rays:.2f} |", flush=True)
        cells.append(titled(title, found))
    print(f"| `mis` | {truth.mean(dtype=np.float64):.4f} | 0 | |")
    cells.append(titled("mis", truth))
    print(f"\n{parsed.scene}, {parsed.size} x {parsed.size}, {parsed.samples} samples")
    if parsed.file:
        write_sheet(parsed.file, in_rows(cells, COLUMNS))


def steps() -> Iterator[tuple[str, tuple[Effect, ...]]]:
    """Yield no effects, then one more at a time, with a title."""
    yield "none", ()
    for count, effect in enumerate(EFFECTS, 1):
        yield f"+ {effect}", EFFECTS[:count]


def distance(picture: Picture, truth: Picture) -> float:
    """Return the relative RMS distance of two pictures, by the measure of glrt's errors."""
    far = np.square(picture - truth, dtype=np.float64)
    floor = DARK * float(truth.mean(dtype=np.float64)) ** 2
    return float(np.sqrt((far / (np.square(truth, dtype=np.float64) + floor)).mean()))


def _rendered(
    context: Context, scene: Scene, samples: int, variant: Variant = PLAIN, **way: Any
) -> Picture:
    renderer = Renderer(scene, None, context, variant=variant, **way)
    try:
        return renderer.render(samples).image().radiance
    finally:
        renderer.release()


if __name__ == "__main__":
    sys.exit(main())
