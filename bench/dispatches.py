"""The longest dispatch of a render, without the first ones."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from unittest.mock import patch

from bench.program import exit_code_of, machine, parser_of
from bench.shape_counts import crowd
from glrt.gpu.context import Context, open_context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.rendering.schedule import INTERACTIVE, DispatchPolicy
from glrt.rendering.tracer import Tracer
from glrt.scene.scene import Scene

SIZE = 1920, 1080  # of the picture, in pixels
SAMPLES = 10  # per pixel


def longest(work: Callable[[], object]) -> float:
    """Seconds of the longest dispatch of a tracer while `work` runs."""
    with _timed() as seconds:
        work()
    return max(seconds)


def row(name: str, scene: Scene, context: Context) -> str:
    """A row of the table: a scene rendered in one call, and in small steps as in the window."""
    width, height = SIZE
    headless, window = (
        Renderer(scene, context=context, width=width, height=height) for _ in range(2)
    )

    def advance() -> None:
        while window.samples < SAMPLES:
            window.advance(INTERACTIVE.limit / 2, SAMPLES)

    figures = longest(lambda: headless.render(SAMPLES)), longest(advance)
    headless.release()
    window.release()
    return f"| {name} | {figures[0]:.3f} s | {figures[1]:.3f} s |"


@contextmanager
def _timed() -> Iterator[list[float]]:
    """Seconds of every dispatch of a tracer, appended while the context lasts."""
    seconds: list[float] = []
    work_on = Tracer.work_on

    def timed(tracer: Tracer, remaining: int, policy: DispatchPolicy, seconds_left: float) -> None:
        start = time.perf_counter()
        work_on(tracer, remaining, policy, seconds_left)
        seconds.append(time.perf_counter() - start)

    with patch.object(Tracer, "work_on", timed):
        yield seconds


def main(arguments: list[str] | None = None) -> int:
    """`python -m bench.dispatches`; returns the exit code."""
    parser_of("dispatches", __doc__).parse_args(arguments)
    return exit_code_of(_print)


def _print() -> None:
    context = open_context()
    print(f"{machine(context.renderer)}, {SIZE[0]} x {SIZE[1]} pixels, {SAMPLES} samples\n")
    print("| scene | `glrt render` | `Renderer.advance` |\n|---|---|---|")
    scenes = {"`cornell`": load("cornell"), "`weekend`": load("weekend")}
    scenes |= {f"{count:,} spheres on a floor": crowd(count) for count in (10_000, 65_000)}
    for name, scene in scenes.items():
        print(row(name, scene, context), flush=True)


if __name__ == "__main__":
    sys.exit(main())
