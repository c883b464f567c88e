"""The speed of the kernel and of its variants, as ratios of interleaved runs.

Every round runs each variant once, so that other load on the machine affects all alike. A ratio is
that of two runs of the same round; median and quartiles are over the rounds.
"""

import argparse
import json
import statistics
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from bench.program import add_rounds, exit_code_of, machine, parser_of
from glrt.core import files
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.process.command import peak_bytes
from glrt.rendering.pipelines import Tier
from glrt.rendering.renderer import Renderer
from glrt.settings import Method

TARGET_ERROR = 0.02  # relative RMS
VARIANCE_SECONDS = 1.5  # of the render that measures the variance
MOST_SAMPLES = 1024


@dataclass(frozen=True)
class Variant:
    """A configuration of the kernel; all render the same image, at different speeds."""

    name: str
    tier: Tier
    one_sample_a_dispatch: bool = False


VARIANTS = (
    Variant("one sample a dispatch", "generic", one_sample_a_dispatch=True),
    Variant("uniform blocks", "generic"),
    Variant("constants without places", "placed"),
    Variant("constants", "complete"),
)


@dataclass(frozen=True)
class Row:
    """The figures of one variant of one scene and method."""

    scene: str
    method: str
    variant: str
    compile_seconds: float
    samples_per_second: float  # pixel samples, median
    ratio: float  # speed over that of the first variant: median of the rounds, then quartiles
    ratio_low: float
    ratio_high: float
    relative_variance: float  # of one sample: squared error times samples
    seconds_to_target: float  # to a relative RMS error of TARGET_ERROR at this size


def measure(
    context: Context, name: str, method: Method, size: int, rounds: int, seconds: float
) -> list[Row]:
    """Measure the variants of one scene in interleaved runs of about `seconds`."""
    renderers = [
        Renderer(load(name), context=context, tier=v.tier, method=method, width=size, height=size)
        for v in VARIANTS
    ]
    samples = _samples_for(renderers[0], seconds)
    times: list[list[float]] = [[] for _ in VARIANTS]
    for _ in range(rounds):
        for runs, renderer, variant in zip(times, renderers, VARIANTS, strict=True):
            runs.append(_run(renderer, samples, variant))
    variance = _relative_variance(renderers[-1])
    rows = [
        _row(name, method, variant, renderer, times, samples * size * size, variance)
        for variant, renderer in zip(VARIANTS, renderers, strict=True)
    ]
    for renderer in renderers:
        renderer.release()
    return rows


def _relative_variance(renderer: Renderer) -> float:
    """Relative variance of one sample, from many samples: few would miss rare bright ones."""
    end = time.perf_counter() + VARIANCE_SECONDS
    image = renderer.render(MOST_SAMPLES, lambda _: time.perf_counter() < end).image()
    return (image.error or float("nan")) ** 2 * image.samples


def _row(
    name: str,
    method: str,
    variant: Variant,
    renderer: Renderer,
    times: list[list[float]],
    work: int,
    variance: float,
) -> Row:
    runs = times[VARIANTS.index(variant)]
    ratios = [base / run for base, run in zip(times[0], runs, strict=True)]
    low, middle, high = statistics.quantiles(ratios, n=4)
    rate = work / statistics.median(runs)
    width, height = renderer.size
    return Row(
        scene=name,
        method=method,
        variant=variant.name,
        compile_seconds=renderer.seconds["compile"],
        samples_per_second=rate,
        ratio=middle,
        ratio_low=low,
        ratio_high=high,
        relative_variance=variance,
        seconds_to_target=variance / TARGET_ERROR**2 * width * height / rate,
    )


def _samples_for(renderer: Renderer, seconds: float) -> int:
    """The samples that the slowest variant takes in `seconds`, at least 4."""
    renderer.step(1)
    start = time.perf_counter()
    renderer.step(1)
    return max(4, int(seconds / (time.perf_counter() - start)))


def _run(renderer: Renderer, samples: int, variant: Variant) -> float:
    """Seconds to render `samples` samples per pixel from an empty film."""
    renderer.update(seed=renderer.settings.seed + 1)
    most = 1 if variant.one_sample_a_dispatch else renderer.most_samples
    start = time.perf_counter()
    while renderer.samples < samples:
        renderer.step(min(most, samples - renderer.samples))
    return time.perf_counter() - start


def table(rows: Sequence[Row]) -> Iterator[str]:
    """The rows as Markdown."""
    yield "| scene | method | variant | million samples/s | ratio (quartiles) | to 2 % |"
    yield "|---|---|---|---|---|---|"
    for row in rows:
        ratio = f"{row.ratio:.2f} ({row.ratio_low:.2f}-{row.ratio_high:.2f})"
        yield (
            f"| {row.scene} | {row.method} | {row.variant} | {row.samples_per_second / 1e6:.2f} "
            f"| {ratio} | {row.seconds_to_target:.3g} s |"
        )


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.kernels`; returns the exit code."""
    parsed = _parser().parse_args(arguments)
    return exit_code_of(lambda: _print(parsed))


def _print(parsed: argparse.Namespace) -> None:
    context = open_context()
    place = machine(context.renderer)
    work = f"{parsed.size} x {parsed.size} pixels, {parsed.rounds} rounds"
    print(f"{place}, {work}\n")
    rows: list[Row] = []
    for name in parsed.scenes:
        for method in parsed.methods:
            print(f"{name}, {method} ...", file=sys.stderr)
            rows += measure(context, name, method, parsed.size, parsed.rounds, parsed.seconds)
    print("\n".join(table(rows)))
    print(f"\npeak memory {(peak_bytes() or 0) / 2**20:.0f} MiB")
    if parsed.json:
        figures = {"place": place, "work": work, "rows": [asdict(row) for row in rows]}
        files.write_text(parsed.json, json.dumps(figures, indent=1) + "\n")


def _parser() -> argparse.ArgumentParser:
    parser = parser_of("kernels", __doc__)
    add = parser.add_argument
    scenes = ["cornell", "lamps", "metals", "sky", "weekend"]
    add("--scenes", nargs="+", metavar="NAME", default=scenes)
    add("--methods", nargs="+", choices=["naive", "nee", "mis"], default=["naive", "mis"])
    add_rounds(parser, size=128, rounds=9)
    add("--seconds", type=float, default=0.5, metavar="S", help="run of the slowest (default: 0.5)")
    add("--json", type=Path, metavar="FILE", help="file for the figures as JSON")
    return parser


if __name__ == "__main__":
    sys.exit(main())
