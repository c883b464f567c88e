"""The commands `render`, `view`, `compare`, `inspect`, `chart`, `stress`, `doctor` and `schema`."""

import argparse
import json
import signal
import sys
from collections.abc import Callable

from glrt import garbage, signals, streams
from glrt.arguments import make_parser, settings_given
from glrt.errors import GlrtError, RenderError
from glrt.files import reason
from glrt.omissions import left_out, omissions
from glrt.order import check_limit, scene_and_settings
from glrt.scene import Scene
from glrt.signals import INTERRUPTED
from glrt.streams import fail

SMALLER = "A smaller picture, or a --crop, needs less."


def main(arguments: list[str] | None = None) -> int:
    """Run a command; returns its exit code. `arguments` are those of the process by default."""
    streams.open_missing()
    signals.loaded()
    garbage.loaded()
    try:
        with signals.handled(signals.interrupt):
            code = _run(arguments)
            sys.stdout.flush()  # a reader that has gone is found out here, not at exit
            return code
    except GlrtError as error:
        return fail(str(error), error.exit_code)
    except KeyboardInterrupt as error:
        return fail(signals.PLAIN, _signal_code(error))
    except BrokenPipeError:
        streams.silence(sys.stdout)
        return 0
    except MemoryError as error:
        return fail(f"out of memory: {reason(error)}. {SMALLER}", RenderError.exit_code)
    except OSError as error:
        streams.settle(sys.stdout)
        return fail(f"{_what_failed(error)}: {reason(error)}", RenderError.exit_code)


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
    return commands[parsed.command](parsed)


def _signal_code(error: KeyboardInterrupt) -> int:
    return int(getattr(error, "exit_code", INTERRUPTED + signal.SIGINT))


def _what_failed(error: OSError) -> str:
    name = getattr(error, "filename", None)
    return f"the command failed at {name}" if name else "the command failed"


def render(arguments: argparse.Namespace) -> int:
    """`glrt render`: the exit code says whether the picture is what was asked for."""
    try:
        from glrt import render_command

        return render_command.render(arguments)
    except KeyboardInterrupt as error:
        return fail(signals.NOTHING, _signal_code(error))


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

    scene, settings = scene_and_settings(arguments)
    print(f"{arguments.scene}: {scene.title or 'no title'}")
    print(f"method {settings.method}, {settings.bounces} bounces, {len(scene.objects)} objects\n")
    for feature in explain(scene, settings):
        print(f"{'in ' if feature.present else 'out'}  {feature.name:<15} {feature.reason}")
    if missing := omissions(scene, settings):
        print(f"\n{left_out(settings, missing)}")
    rounds = iterations_per_sample(scene, settings)
    print(
        f"\nA sample takes {'about' if has_tree(scene) else 'up to'} {rounds:,} rounds of loops; "
        f"llvmpipe ends those of a dispatch after {LLVMPIPE_ROUNDS:,}."
    )
    for text in cautions(scene, settings):
        print(f"\ncaution: {text}")
    if arguments.error is not None:
        from glrt.lab.advice import advise

        check_limit("error", arguments.error)
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
