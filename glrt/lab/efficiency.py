"""What each switch of a render buys: variance a sample, time a sample, and 1 / (variance x time).

Every round renders each variant once, with random numbers of its own; a variant differs from the
defaults in one setting. The variance is that of pictures about the mean of all of them, so that
no claim of a picture about its own noise is believed, relative to the radiance as in `stats`.
"""

import argparse
import statistics
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.context import Context, open_context
from glrt.errors import GlrtError
from glrt.library import load
from glrt.renderer import Renderer
from glrt.scene import Scene
from glrt.settings import settings_for
from glrt.stats import DARK

SWITCHES: dict[str, dict[str, Any]] = {
    "defaults": {},
    "independent": {"sampler": "independent"},
    "no roulette": {"roulette": False},
    "nee": {"method": "nee"},
    "naive": {"method": "naive"},
}
SCENES = ("cornell", "room", "lamps", "sky", "metals", "lens")
SAMPLES = 32  # of a run: two blocks of Sobol's points


class Row(NamedTuple):
    """The figures of one variant; ratios are to the first one of its scene."""

    scene: str
    variant: str
    variance: float  # relative, of one sample
    uncertainty: float  # of the variance, relative: one standard error
    microseconds: float  # a pixel sample, median
    fewer_samples: float  # for the same error
    slower: float  # median over the rounds
    efficiency: float


class Runs:
    """What one variant did."""

    def __init__(self, renderer: Renderer) -> None:
        """Nothing yet."""
        self.renderer = renderer
        self.seconds: list[float] = []
        self.pictures: list[NDArray[np.float32]] = []

    def add(self, seed: int) -> None:
        """Render once more, from an empty film."""
        self.renderer.update(seed=seed)
        start = time.perf_counter()
        self.renderer.render(SAMPLES)
        self.seconds.append(time.perf_counter() - start)
        self.pictures.append(self.renderer.image().radiance)

    def variances(self, scale: NDArray[np.float64]) -> NDArray[np.float64]:
        """An estimate of the relative variance of one sample from each picture."""
        mean = np.mean(self.pictures, axis=0, dtype=np.float64)
        count = len(self.pictures)
        squares = [np.mean(np.square(picture - mean) / scale) for picture in self.pictures]
        return np.array(squares) * SAMPLES * count / (count - 1)


def measure(
    context: Context,
    name: str,
    size: int,
    rounds: int,
    switches: Mapping[str, Mapping[str, Any]] = SWITCHES,
) -> list[Row]:
    """Interleave the variants of one scene, at `size` x `size` pixels."""
    scene, frame = scene_of(name), {"width": size, "height": size}
    settings = {label: settings_for(scene.render, **frame, **s) for label, s in switches.items()}
    runs = {label: Runs(Renderer(scene, s, context, "baked")) for label, s in settings.items()}
    for number in range(rounds + 1):  # the first one warms up
        for place, one in enumerate(runs.values()):
            one.add(seed=1 + number * len(runs) + place)
    for one in runs.values():
        del one.seconds[0], one.pictures[0]
        one.renderer.release()
    return list(_rows(name, runs))


def scene_of(name: str) -> Scene:
    """A scene by name; `room` is `cornell` with a white ball for the one of glass: no caustic."""
    if name != "room":
        return load(name)
    cornell = load("cornell")
    white = {**cornell.materials, "glass": cornell.materials["white"]}
    return cornell.model_copy(update={"materials": white})


def _rows(name: str, runs: Mapping[str, Runs]) -> Iterator[Row]:
    everything = [picture for one in runs.values() for picture in one.pictures]
    mean: NDArray[np.float64] = np.mean(everything, axis=0, dtype=np.float64)
    scale = np.square(mean) + DARK * mean.mean() ** 2
    first, *_ = runs.values()
    base = first.variances(scale).mean()
    for label, one in runs.items():
        found = one.variances(scale)
        ratios = [a / b for a, b in zip(one.seconds, first.seconds, strict=True)]
        slower = statistics.median(ratios)
        yield Row(
            scene=name,
            variant=label,
            variance=float(found.mean()),
            uncertainty=float(found.std(ddof=1) / np.sqrt(len(found)) / found.mean()),
            microseconds=statistics.median(one.seconds) / (SAMPLES * mean[..., 0].size) * 1e6,
            fewer_samples=float(base / found.mean()),
            slower=slower,
            efficiency=float(base / found.mean()) / slower,
        )


def table(rows: Sequence[Row]) -> Iterator[str]:
    """The rows as Markdown."""
    yield "| scene | variant | variance a sample | us a sample | 1 / variance | time | efficiency |"
    yield "|---|---|---|---|---|---|---|"
    for row in rows:
        variance = f"{row.variance:.3g} +- {100 * row.uncertainty:.0f} %"
        yield (
            f"| {row.scene} | {row.variant} | {variance} | {row.microseconds:.3f} "
            f"| {row.fewer_samples:.2f} | {row.slower:.2f} | {row.efficiency:.2f} |"
        )


def main(arguments: list[str] | None = None) -> int:
    """`python -m glrt.lab.efficiency`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    try:
        context = open_context()
        rows: list[Row] = []
        for name in parsed.scenes:
            print(f"{name} ...", file=sys.stderr)
            rows += measure(context, name, parsed.size, parsed.rounds)
        print("\n".join(table(rows)))
    except GlrtError as error:
        print(f"glrt: {' '.join(str(error).split())}", file=sys.stderr)
        return error.exit_code
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m glrt.lab.efficiency", description=__doc__)
    add = parser.add_argument
    add("--scenes", nargs="+", metavar="NAME", default=SCENES)
    add("--size", type=int, default=64, metavar="N", help="pixels a side (default: 64)")
    add("--rounds", type=int, default=40, metavar="N", help="runs of each (default: 40)")
    return parser


if __name__ == "__main__":
    sys.exit(main())
