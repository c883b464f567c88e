"""The cost of a cluster, of its scheduler and of several workers: `python -m bench.clusters`.

The scheduler's share is measured with workers that sleep in place of rendering, as ten machines do
for the machine of the scheduler: 1 - (time of the tasks) / (workers x time). They send back as many
bytes as a frame of EXR has. Films are rendered by one process, and by one and two local workers, in
turns; the processors are the same, so a ratio of 1 means that a cluster costs nothing.
"""

import argparse
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median

from bench.program import at_least, exit_code_of, machine, parser_of
from bench.sleeping import Sleep
from glrt.cluster.addresses import parse_address
from glrt.cluster.clusters import opened
from glrt.cluster.crew import Crew
from glrt.cluster.films import render_frames_on
from glrt.gpu.context import open_context
from glrt.image.sources import load
from glrt.rendering.stopping import Interruption
from glrt.series.film import Film
from glrt.series.outputs import parse_output
from glrt.series.rendering import RenderOptions
from glrt.series.series import Series
from glrt.settings import settings_for

LENGTHS = (1.0, 10.0)  # seconds of a task
TASKS = 10  # of each worker


def main(arguments: list[str] | None = None) -> int:
    """Print both tables; returns the exit code."""
    parser = parser_of("clusters", __doc__)
    add = parser.add_argument
    add("--workers", type=at_least(1), default=10, help="that sleep (default: 10)")
    add("--scene", default="cradle", help="of the film (default: cradle)")
    add("--frames", type=at_least(2), default=8, help="of the film (default: 8)")
    add("--samples", type=at_least(16), default=256, help="of a pixel (default: 256)")
    add("--size", type=at_least(16), default=256, help="width and height (default: 256)")
    add("--rounds", type=at_least(1), default=3, help="of the film (default: 3)")
    return exit_code_of(lambda: _run(parser.parse_args(arguments)))


def _run(parsed: argparse.Namespace) -> None:
    _print_shares(parsed.workers)
    _print_films(parsed)
    print(f"\n{machine(open_context().renderer)}")


def _print_shares(workers: int) -> None:
    print(f"| seconds of a task | {workers} workers that sleep, s | scheduler's share |")
    print("|---|---|---|")
    with _crew(workers) as crew:
        _slept(crew, 0.0, workers)  # workers open OpenGL once
        for length in LENGTHS:
            taken = _slept(crew, length, TASKS * workers)
            share = 1 - TASKS * length / taken
            print(f"| {length:g} | {taken:.2f} | {100 * share:.1f} % |", flush=True)


def _print_films(parsed: argparse.Namespace) -> None:
    ways: dict[str, Callable[[Series, range, Path], None]] = {
        "one process": _alone,
        "local:1": lambda *film: _on(1, *film),
        "local:2": lambda *film: _on(2, *film),
    }
    times: dict[str, list[float]] = {way: [] for way in ways}
    scene = load(parsed.scene)
    size = {"width": parsed.size, "height": parsed.size}
    series = Series(scene, settings_for(scene.render, samples=parsed.samples, **size), None, ())
    for _ in range(parsed.rounds):
        for way, film in ways.items():
            with tempfile.TemporaryDirectory() as folder:
                start = time.perf_counter()
                film(series, range(parsed.frames), Path(folder))
                times[way].append(time.perf_counter() - start)
    print("\n| film | s | times the frames a minute of local:1 |\n|---|---|---|")
    for way, found in times.items():
        gains = [one / own for one, own in zip(times["local:1"], found, strict=True)]
        print(f"| {way} | {median(found):.2f} | {median(gains):.3f} |")


@contextmanager
def _crew(workers: int) -> Iterator[Crew]:
    address = parse_address(f"local:{workers}")
    with opened(address) as client:
        yield Crew(client, address.text, "auto", Interruption(), print)


def _slept(crew: Crew, seconds: float, count: int) -> float:
    """Return the time of so many tasks."""
    start = time.perf_counter()
    done = [number for number, _ in crew.answers(Sleep(seconds), range(count))]
    assert sorted(done) == [*range(count)]
    return time.perf_counter() - start


def _alone(series: Series, frames: range, folder: Path) -> None:
    film = Film(series, frames, parse_output(str(folder / "%d.exr")), RenderOptions())
    for _ in film.render(Interruption()):
        pass


def _on(workers: int, series: Series, frames: range, folder: Path) -> None:
    output = parse_output(str(folder / "%d.exr"))
    with _crew(workers) as crew:
        for frame in render_frames_on(crew, series, frames, output, RenderOptions()):
            assert not frame.failure


if __name__ == "__main__":
    raise SystemExit(main())
