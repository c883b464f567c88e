"""The speed of the WGSL version against the kernel's: `python -m tests.wgsl.speed`.

Ratios of interleaved runs, the same paths everywhere: `naive`, no roulette, one set of seeds.
"""

import argparse
import statistics
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence

from glrt.core.errors import GlrtError
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.scene.scene import Scene
from glrt.settings import Settings
from tests.wgsl.device import describe, open_device
from tests.wgsl.program import RayTracer
from tests.wgsl.table import COMPILER_AT_LIBERTY
from tests.wgsl.tracer import Tracer, naive

SCENES = ("cornell", "lamps", "metals")
WGSL = "WGSL"
Run = Callable[[int], None]  # adds so many samples


def main(arguments: list[str] | None = None) -> int:
    """Returns the exit code."""
    parsed = _parser().parse_args(arguments)
    try:
        for line in _lines(parsed.scenes, parsed.size, parsed.samples, parsed.rounds):
            print(line, flush=True)
    except GlrtError as error:
        print(f"glrt: {' '.join(str(error).split())}", file=sys.stderr)
        return error.exit_code
    return 0


def _lines(scenes: Sequence[str], size: int, samples: int, rounds: int) -> Iterator[str]:
    device, context = open_device(), open_context()
    tracers = {
        WGSL: RayTracer(device),
        "WGSL without `exact`": RayTracer(device, COMPILER_AT_LIBERTY),
    }
    yield f"{describe(device)}; {context.renderer}; {size} x {size}, {samples} samples a run"
    for name in scenes:
        scene = load(name)
        settings = naive(scene, width=size, height=size)
        runs: dict[str, Run] = {
            **{title: _frames(Tracer(each, scene, settings)) for title, each in tracers.items()},
            **_kernels(context, scene, settings),
        }
        seconds = _interleaved(runs, samples, rounds)
        rate = size * size * samples / statistics.median(seconds[WGSL]) / 1e6
        yield f"\n{name}: {rate:.2f} million samples/s by WGSL; the others relative to that"
        for title, taken in seconds.items():
            ratios = [base / own for base, own in zip(seconds[WGSL], taken, strict=True)]
            yield f"  {statistics.median(ratios):5.2f}  {title}"


def _frames(tracer: Tracer) -> Run:
    def run(samples: int) -> None:
        tracer.render(tracer.samples + samples)

    return run


def _kernels(context: Context, scene: Scene, settings: Settings) -> Mapping[str, Run]:
    generic = Renderer(scene, settings, context)
    baked = Renderer(scene, settings, context, tier="complete")

    def step_by_step(samples: int) -> None:
        generic.restart()
        for _ in range(samples):
            generic.step(1)

    def at_once(renderer: Renderer) -> Run:
        def run(samples: int) -> None:
            renderer.restart()
            renderer.render(samples)

        return run

    return {
        "glrt, one sample a dispatch": step_by_step,
        "glrt, uniform blocks": at_once(generic),
        "glrt, constants": at_once(baked),
    }


def _interleaved(runs: Mapping[str, Run], samples: int, rounds: int) -> dict[str, list[float]]:
    """Seconds of each run, round by round, after one that compiles."""
    seconds: dict[str, list[float]] = {title: [] for title in runs}
    for run in runs.values():
        run(1)
    for _ in range(rounds):
        for title, run in runs.items():
            start = time.perf_counter()
            run(samples)
            seconds[title].append(time.perf_counter() - start)
    return seconds


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.wgsl.speed", description=__doc__)
    parser.add_argument("--scenes", nargs="+", default=SCENES, metavar="NAME")
    for name, default in (("size", 256), ("samples", 16), ("rounds", 5)):
        parser.add_argument(f"--{name}", type=int, default=default, metavar="N")
    return parser


if __name__ == "__main__":
    sys.exit(main())
