"""Whether a film takes longer than its stills: `python -m bench.films`.

The time of a film is that from its scene to the written file. The time of its stills is that of
their renders alone, each with its shapes written into the kernel, without set-up and compiling.
"""

import argparse
import tempfile
import time
from pathlib import Path

from bench.program import exit_code_of, machine, parser_of
from glrt.gpu.context import open_context
from glrt.image.sources import load
from glrt.rendering.renderer import Renderer
from glrt.rendering.stopping import Interruption
from glrt.series.film import Film
from glrt.series.outputs import parse_output
from glrt.series.rendering import RenderOptions
from glrt.series.series import Series
from glrt.series.sweeps import parse_sweep
from glrt.settings import settings_for

FILMS = {  # what moves, by scene
    "cradle": "animation",
    "spot": "turntable",
    "lens": "turntable",
    "weekend": "turntable",
    "metals": "camera.fov=25:40:8",
}


def main(arguments: list[str] | None = None) -> int:
    """Print a row for each film; returns the exit code."""
    parser = parser_of("films", __doc__)
    parser.add_argument(
        "--scenes", nargs="+", choices=FILMS, default=[*FILMS], metavar="NAME", help="default: all"
    )
    parser.add_argument("--frames", type=int, default=8, help="frames of a film (default: 8)")
    parser.add_argument("--samples", type=int, default=256, help="of a pixel (default: 256)")
    parser.add_argument("--size", type=int, default=256, help="width and height (default: 256)")
    parsed = parser.parse_args(arguments)
    return exit_code_of(lambda: _run(parsed))


def _run(parsed: argparse.Namespace) -> None:
    renderer = ""
    print("| scene | film, s | renders of its stills, s | stills / film |\n|---|---|---|---|")
    for name in parsed.scenes:
        series = _series(name, parsed)
        with tempfile.TemporaryDirectory() as folder:
            start = time.perf_counter()
            _film(series, parsed.frames, Path(folder) / "film.webp")
            film = time.perf_counter() - start
        stills, renderer = _stills(series, parsed.frames)
        print(f"| `{name}` | {film:.2f} | {stills:.2f} | {stills / film:.3f} |", flush=True)
    print(f"\n{machine(renderer)}")


def _series(name: str, parsed: argparse.Namespace) -> Series:
    scene, way = load(name), FILMS[name]
    size = {"width": parsed.size, "height": parsed.size}
    settings = settings_for(scene.render, samples=parsed.samples, **size)
    sweeps = (parse_sweep(way),) if "=" in way else ()
    return Series(scene, settings, parsed.frames if way == "turntable" else None, sweeps)


def _film(series: Series, count: int, path: Path) -> None:
    film = Film(series, range(count), parse_output(str(path)), RenderOptions())
    film.output.check(0)
    for _ in film.render(Interruption()):
        pass
    film.write(keeps_frames=False)


def _stills(series: Series, count: int) -> tuple[float, str]:
    """Seconds of the renders of all stills, and the renderer's name."""
    context, seconds = open_context(), 0.0
    for number in range(count):
        still = series.still(number)
        renderer = Renderer(still.scene, still.settings, context, "complete")
        start = time.perf_counter()
        renderer.render().image()
        seconds += time.perf_counter() - start
        renderer.release()
    return seconds, context.renderer


if __name__ == "__main__":
    raise SystemExit(main())
