"""What reuse of points brings to method `resampled`: the table of docs/explanation/probes.md.

`python -m bench.reuse` renders a scene by `gather` and by `resampled` with each reuse, in turns, by
other seeds. Noise is the spread of pixels over these seeds, relative; gain is how much less work
equal noise takes than by `gather`, probes included. `--sheet FILE` writes a row of pictures.
"""

import argparse
import math
import sys
import time
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bench.contact_sheet import check_sheet, save_sheet
from bench.program import at_least, exit_code_of, machine, parser_of
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.image.tonemap import expose_and_encode
from glrt.rendering.renderer import Renderer

SCENES = ("methods/diffuse", "methods/two_rooms")
WAYS: dict[str, dict[str, Any]] = {
    "gather": {"method": "gather"},
    **{f"reuse {way}": {"reuse": way} for way in ("none", "temporal", "spatial", "both")},
    "spatial, biased": {"reuse": "spatial", "unbiased": False},
    "both, biased": {"reuse": "both", "unbiased": False},
}
FEW = (1, 16, 64)  # samples
SHOWN = ("gather", "reuse none", "reuse spatial", "reuse both", "both, biased", "")
ROW = (384, 16)  # pixels a side and samples of the pictures; those of "" have MANY
MANY = 1024
DIM = 0.01  # of the squared mean: what is dark counts less

Pictures = NDArray[np.float64]  # (seeds, H, W, 3)


class Found(NamedTuple):
    """Pictures of a way by some seeds, and how long each took."""

    pictures: Pictures
    seconds: list[float]

    @property
    def noise(self) -> float:
        """Of a picture, relative: rms over pixels and channels."""
        mean = self.pictures.mean(axis=0)
        scale = mean**2 + DIM * mean.mean() ** 2
        return math.sqrt(float(np.mean(self.pictures.var(axis=0, ddof=1) / scale)))

    @property
    def light(self) -> tuple[float, float]:
        """The mean of all pixels, and its standard error."""
        means = self.pictures.mean(axis=(1, 2, 3))
        return float(means.mean()), float(means.std(ddof=1) / math.sqrt(len(means)))

    def gain_over(self, other: "Found") -> float:
        """How much less work equal noise takes."""
        work = [found.noise**2 * median(found.seconds) for found in (self, other)]
        return work[1] / work[0]


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.reuse`; returns the exit code."""
    parser = parser_of("reuse", __doc__)
    parser.add_argument("scenes", nargs="*", default=SCENES, metavar="SCENE")
    for name, default, text in (("size", 128, "pixels a side"), ("seeds", 8, "pictures of each")):
        note = f"{text} (default: {default})"
        parser.add_argument(f"--{name}", type=at_least(2), default=default, metavar="N", help=note)
    parser.add_argument("--sheet", type=Path, metavar="FILE", help="write a row of pictures alone")
    given = parser.parse_args(arguments)
    return exit_code_of(lambda: _save_row(given.sheet) if given.sheet else _run(given))


def _run(given: argparse.Namespace) -> None:
    context = open_context()
    size = f"{given.size} x {given.size} pixels"
    print(f"{machine(context.renderer)}; {size}, {given.seeds} seeds.\n")
    counts = (f"{samples} samples" for samples in FEW)
    print(f"| scene | way | noise: {' | '.join(counts)} | seconds | gain | light beside gather |")
    print("|---|---|---|---|---|---|---|---|")
    for name in given.scenes:
        rows = {samples: _found(name, context, given, samples) for samples in FEW}
        for way in WAYS:
            noise = (f"{100 * rows[samples][way].noise:.1f} %" for samples in FEW)
            last = rows[FEW[-1]]
            gain = last[way].gain_over(last["gather"])
            cells = f"{median(last[way].seconds):.2f}", f"{gain:.2f}", _next_to(last, way)
            print(f"| {name} | {way} | {' | '.join((*noise, *cells))} |")
    context.gl.release()


def _found(
    name: str, context: Context, given: argparse.Namespace, samples: int
) -> dict[str, Found]:
    """Pictures of so many samples by each way, in turns."""
    size = {"width": given.size, "height": given.size, "samples": samples}
    found: dict[str, Found] = {}
    with ExitStack() as opened:
        renderers = {way: _renderer(name, context, {**size, **WAYS[way]}) for way in WAYS}
        for renderer in renderers.values():
            opened.callback(renderer.release)
        taken: dict[str, list[tuple[NDArray[np.float32], float]]] = {way: [] for way in WAYS}
        for seed in range(given.seeds):
            for way, renderer in renderers.items():
                renderer.update(seed=1 + seed)
                start = time.perf_counter()
                renderer.render()
                taken[way].append((renderer.image().radiance, time.perf_counter() - start))
    for way, runs in taken.items():
        pictures = np.array([picture for picture, _ in runs], np.float64)
        found[way] = Found(pictures, [seconds for _, seconds in runs])
    return found


def _renderer(name: str, context: Context, settings: Mapping[str, Any]) -> Renderer:
    """One that has compiled, and found where probes stand."""
    settings = {"method": "resampled", **settings}
    return Renderer(load(name), None, context, "baked", **settings).render(1)


def _next_to(found: Mapping[str, Found], way: str) -> str:
    (light, error), (truth, other) = found[way].light, found["gather"].light
    return f"{100 * (light / truth - 1):+.2f} % (± {100 * math.hypot(error, other) / truth:.2f})"


def _save_row(file: Path) -> None:
    """Pictures of few samples by some ways, and one of many."""
    check_sheet(file)
    context = open_context()
    size, few = ROW
    row = []
    for way in SHOWN:
        settings = {"samples": few if way else MANY, **WAYS[way or "gather"]}
        renderer = _renderer(SCENES[0], context, {"width": size, "height": size, **settings})
        row.append(expose_and_encode(renderer.render().image().radiance, 0.0, "neutral"))
        renderer.release()
    context.gl.release()
    save_sheet(row, file)


if __name__ == "__main__":
    sys.exit(main())
