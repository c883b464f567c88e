"""The commands `render`, `view`, `compare`, `inspect`, `chart`, `stress`, `doctor` and `schema`."""

import argparse
import json
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from glrt import signals, streams
from glrt.arguments import is_automatic, make_parser, refuse_later, settings_given
from glrt.doubt import doubt
from glrt.errors import GlrtError, RenderError, UsageError
from glrt.files import reason
from glrt.job import Interruption, Limits, peak_bytes, run, samples_limit, since_start
from glrt.library import load_recipe, recipe_of
from glrt.omissions import omissions
from glrt.scene import Scene, with_lights
from glrt.settings import Settings, settings_for
from glrt.signals import INTERRUPTED


def main(arguments: list[str] | None = None) -> int:
    """Run a command; returns its exit code. `arguments` are those of the process by default."""
    streams.open_missing()
    signals.loaded()
    try:
        with signals.handled(signals.interrupt):
            code = _run(arguments)
            sys.stdout.flush()  # a reader that has gone is found out here, not at exit
            return code
    except GlrtError as error:
        return _fail(str(error), error.exit_code)
    except KeyboardInterrupt as error:
        return _fail(signals.NOTHING, getattr(error, "exit_code", INTERRUPTED + 2))
    except BrokenPipeError:
        streams.silence(sys.stdout)
        return 0
    except (OSError, MemoryError) as error:
        streams.settle(sys.stdout)
        return _fail(f"{_what_failed(error)}: {reason(error)}", RenderError.exit_code)


def _run(arguments: list[str] | None) -> int:
    commands: dict[str, Callable[[argparse.Namespace], int]] = {
        "render": render,
        "view": view,
        "compare": compare,
        "inspect": inspect,
        "chart": chart,
        "stress": stress,
        "doctor": doctor,
        "schema": schema,
    }
    try:
        parsed = make_parser().parse(arguments)
    except SystemExit:  # after --help and --version
        return 0
    refuse_later(parsed)
    return commands[parsed.command](parsed)


def _what_failed(error: OSError | MemoryError) -> str:
    name = getattr(error, "filename", None)
    return f"the command failed at {name}" if name else "the command failed"


def render(arguments: argparse.Namespace) -> int:
    """`glrt render`: the exit code says whether the picture is what was asked for."""
    from glrt.cautions import cautions
    from glrt.image import check_writable

    scene, settings, limits = _job(arguments)
    for output in arguments.outputs:
        check_writable(output)
    for text in [] if arguments.quiet else cautions(scene, settings):
        print(f"glrt: caution: {text}", file=sys.stderr)
    if is_automatic(arguments):
        from glrt.lab.advice import choose

        settings, limits = choose(arguments, scene, settings, limits)
    with Interruption().watched() as interruption:
        return _render(arguments, scene, settings, limits, interruption)


def view(arguments: argparse.Namespace) -> int:
    """`glrt view`: exit code 3 where no window can be opened."""
    from glrt.ui import command

    return command.view(arguments, settings_given(arguments))


def compare(arguments: argparse.Namespace) -> int:
    """`glrt compare`: exit code 1 for pictures that differ by more than their noise."""
    from glrt.compare_command import compare_files

    return compare_files(arguments)


def inspect(arguments: argparse.Namespace) -> int:
    """`glrt inspect`: what the kernel contains and leaves out."""
    from glrt.cautions import cautions
    from glrt.needs import explain, has_tree
    from glrt.schedule import iterations_per_sample
    from glrt.selftest import LLVMPIPE_ROUNDS

    scene, settings = _scene_and_settings(arguments)
    print(f"{arguments.scene}: {scene.title or 'no title'}")
    print(f"method {settings.method}, {settings.bounces} bounces, {len(scene.objects)} objects\n")
    for feature in explain(scene, settings):
        print(f"{'in ' if feature.present else 'out'}  {feature.name:<15} {feature.reason}")
    if missing := omissions(scene, settings):
        print(f"\n{_left_out(settings, missing)}")
    rounds = iterations_per_sample(scene, settings)
    print(
        f"\nA sample takes {'about' if has_tree(scene) else 'up to'} {rounds:,} rounds of loops; "
        f"llvmpipe ends those of a dispatch after {LLVMPIPE_ROUNDS:,}."
    )
    for text in cautions(scene, settings):
        print(f"\ncaution: {text}")
    if arguments.error is not None:
        from glrt.lab.advice import advise

        _check_limit("error", arguments.error)
        advise(arguments, scene, settings)
    return 0


def chart(arguments: argparse.Namespace) -> int:
    """`glrt chart`: error against time of every method."""
    from glrt.lab.chart import chart_scenes

    return chart_scenes(arguments)


def stress(arguments: argparse.Namespace) -> int:
    """`glrt stress`: exit code 1 when a guarantee is broken."""
    from glrt.lab.stress.command import stress as run_cases

    return run_cases(arguments)


def doctor(arguments: argparse.Namespace) -> int:
    """`glrt doctor`: exit code 3 when no route works."""
    from glrt.doctor import report

    text, works = report(arguments.json)
    print(text)
    return 0 if works else 3


def schema(_arguments: argparse.Namespace) -> int:
    """`glrt schema`: the scene format as JSON Schema."""
    print(json.dumps(Scene.model_json_schema(), indent=2))
    return 0


def _job(arguments: argparse.Namespace) -> tuple[Scene, Settings, Limits]:
    scene, settings = _scene_and_settings(arguments)
    for name in ("time", "error"):
        _check_limit(name, getattr(arguments, name))
    open_ended = arguments.time is not None or arguments.error is not None
    samples = samples_limit(getattr(arguments, "samples", None), settings.samples, open_ended)
    settings = settings_for(settings, samples=samples)
    return scene, settings, Limits(samples, arguments.time, arguments.error)


def _check_limit(name: str, value: float | None) -> None:
    if value is not None and not 0 < value < float("inf"):
        raise UsageError(f"--{name} must be a number above 0, got {value:g}.")


def _scene_and_settings(arguments: argparse.Namespace) -> tuple[Scene, Settings]:
    scene, recipe = load_recipe(arguments.scene)
    settings = settings_for(recipe or scene.render, **settings_given(arguments))
    return with_lights(scene, dict(arguments.lights)), settings


def _render(
    arguments: argparse.Namespace,
    scene: Scene,
    settings: Settings,
    limits: Limits,
    interruption: Interruption,
) -> int:
    from glrt.again import open_renderer

    recipe, route = recipe_of(arguments.scene), arguments.context
    renderer = open_renderer(scene, settings, recipe, route, "baked", arguments.pipeline)
    setup = since_start() - renderer.compile_seconds
    start = time.perf_counter()
    with _watch(arguments, limits) as watch:
        error, understatement = run(renderer, limits, interruption, watch)
    seconds = {
        "setup": setup,
        "compile": renderer.compile_seconds,
        "render": time.perf_counter() - start,
    }
    if not renderer.samples:
        return _fail(signals.NOTHING, _signal_code(interruption))
    image = renderer.image()
    for output in arguments.outputs:
        image.save(output)
    _tell(arguments, renderer, seconds, error)
    if interruption.signal is not None:
        text = f"interrupted after {renderer.samples} samples, which are saved"
        return _fail(text, _signal_code(interruption))
    if limits.error is not None and (error is None or error > limits.error):
        text = "unknown" if error is None else f"{error:.3g}"
        return _fail(
            f"--error {limits.error:g} was not reached: it is {text} after {renderer.samples} "
            "samples. The picture is saved; give more --samples or --time.",
            1,
        )
    if not arguments.quiet and (caution := doubt(understatement, limits.error)):
        print(f"glrt: caution: {caution}", file=sys.stderr)
    return 0


def _signal_code(interruption: Interruption) -> int:
    return INTERRUPTED + (interruption.signal or 0)


@contextmanager
def _watch(arguments: argparse.Namespace, limits: Limits) -> Iterator[Any]:
    if arguments.quiet or not sys.stderr.isatty():
        yield None
        return
    from glrt.progress import progress_bar

    with progress_bar(limits) as watch:
        yield watch


def _tell(
    arguments: argparse.Namespace, renderer: Any, seconds: dict[str, float], error: float | None
) -> None:
    """The figures of a render: a line of JSON on stdout, or of prose on stderr."""
    width, height = renderer.size
    rate = renderer.samples * width * height / max(seconds["render"], 1e-9)
    if arguments.json:
        print(json.dumps(_figures(arguments, renderer, seconds, rate, error)), flush=True)
    elif not arguments.quiet:
        known = "" if error is None else f", estimated error {100 * error:.2g} %"
        names = ", ".join(arguments.outputs)
        print(
            f"Wrote {names}: {width} x {height}, {renderer.samples} samples in "
            f"{seconds['render']:.1f} s ({rate / 1e6:.2f} million samples/s){known}.",
            file=sys.stderr,
        )
        if dropped := renderer.nonfinite():
            print(
                f"{dropped:,} samples were dropped: they were not finite, or longer than the "
                "driver runs loops. Where they are many the picture is biased: use fewer bounces.",
                file=sys.stderr,
            )
        if missing := omissions(renderer.scene, renderer.settings):
            print(_left_out(renderer.settings, missing), file=sys.stderr)


def _left_out(settings: Settings, missing: list[str]) -> str:
    return (
        f"Method {settings.method} leaves light out, which no estimated error contains: "
        f"{'; '.join(missing)}."
    )


def _figures(
    arguments: argparse.Namespace,
    renderer: Any,
    seconds: dict[str, float],
    rate: float,
    error: float | None,
) -> dict[str, Any]:
    settings = renderer.settings
    return {
        "scene": arguments.scene,
        "width": settings.width,
        "height": settings.height,
        "samples": renderer.samples,
        "bounces": settings.bounces,
        "method": settings.method,
        "seed": settings.seed,
        "pipeline": renderer.pipeline,
        "context": renderer.context.route,
        "renderer": renderer.context.renderer,
        "seconds": {name: round(value, 6) for name, value in seconds.items()},
        "samples_per_second": round(rate, 1),
        "error": error,
        "nonfinite": renderer.nonfinite(),
        "peak_bytes": peak_bytes(),
    }


def _fail(message: str, code: int) -> int:
    streams.tell(f"glrt: {' '.join(message.split())}")
    return code
