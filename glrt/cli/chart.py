"""`glrt chart`: measure, chart and summarise the error of each method over its time.

Rounds are saved in DIR/NAME.rounds.json as they are made. The same command continues from there
after an interruption; with more rounds, it adds to them.
"""

import argparse
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from glrt.analysis.chart import files as method_files
from glrt.analysis.chart.choice import MOST_NAMED, MOST_SHOWN, called
from glrt.analysis.chart.experiment import Plan, Tell, frame_of, measure_scene
from glrt.analysis.chart.files import save_chart
from glrt.analysis.chart.sections import section_of
from glrt.analysis.chart_page import save_chart_page
from glrt.analysis.motion import report as motion
from glrt.analysis.motion.measure import TrackPlan, tracks_of
from glrt.analysis.motion.report import PAGE, save_page, save_tracks
from glrt.analysis.outputs import Outputs, prepare_outputs
from glrt.analysis.plot import MOST_CURVES
from glrt.cli.moving_options import add_moving, hysteresis_of, ways_of
from glrt.cli.options import SCENE, add_context, add_files, file_rules
from glrt.core.errors import UsageError
from glrt.gpu.context import Choice, open_context
from glrt.image.sources import STANDARD_INPUT, FileRules, load_recipe
from glrt.process.command import file_names
from glrt.process.signals import INTERRUPTED
from glrt.rendering.stopping import Interruption
from glrt.scene.files.path_text import text_of
from glrt.scene.scene import Scene

DESCRIPTION = (
    "Measure the error of every method against its time; write charts (SVG, PNG), figures (CSV, "
    "JSON) and a summary (chart.md) into a folder, or a page (HTML)."
)
EPILOG = (
    "The same command continues after an interruption. References are kept in the user's cache "
    "folder. Exit codes: 0 done, 2 wrong usage or scene, or no matplotlib, 3 no usable OpenGL, "
    "4 a render failed, 129, 130 and 143 interrupted."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument("scenes", metavar="SCENE", nargs="+", help=SCENE)
    parser.add_argument("-o", dest="output", metavar="DIR", help="output folder")
    parser.add_argument(
        "--html",
        metavar="FILE",
        help="a .html file with all charts and tables, whose curves can be read and switched; "
        "without -o, only this is written, and an interrupted run is lost",
    )
    for name, default, kind, text in (
        ("height", 64, int, "height of the pictures in pixels"),
        ("rounds", 5, int, "runs of each variant"),
        ("seconds", 60.0, float, "time for the runs of a scene; its reference takes up to half"),
    ):
        metavar = "N" if kind is int else "S"
        note = f"{text} (default: {default:g})"
        parser.add_argument(f"--{name}", type=kind, default=default, metavar=metavar, help=note)
    parser.add_argument(
        "--curve",
        action="append",
        default=[],
        metavar="NAME",
        help="show this variant in the picture too, such as ddgi or 'mis, no roulette'; may be "
        f"given {MOST_NAMED} times; 'mis, adaptive' is measured only if it is named. A picture has "
        f"{MOST_SHOWN} curves at most, the table has all",
    )
    add_moving(parser)
    add_context(parser)
    add_files(parser)
    parser.add_argument("--quiet", action="store_true", help="print no progress and no summary")


REFERENCE = 512  # samples of each half of a reference of --temporal
_LIMITS = {"height": (8, 4096), "rounds": (2, 1000), "seconds": (0.1, 1e6)}


def run(arguments: argparse.Namespace) -> int:
    """Write a chart of each scene and one page for all of them; return the exit code."""
    plan, ways, kept = _plan(arguments), ways_of(arguments), hysteresis_of(arguments)
    small = sum(way.mode == "upsample" for way in ways)  # each has an enlarged picture, too
    if (curves := len(ways) + small + len(kept) + bool(kept)) > MOST_CURVES:
        raise UsageError(
            f"A chart shows at most {MOST_CURVES} curves, and this asks for {curves}: choose fewer "
            "of --temporal, --predictor, --traced, --factor or --hysteresis."
        )
    scenes = _scenes(arguments.scenes, file_rules(arguments))
    _check_named(plan, scenes)
    page = PAGE if ways else "chart.md"
    outputs = prepare_outputs(arguments.output, arguments.html, [page])
    with Interruption().watched() as interruption:
        try:
            with _progress(arguments.quiet) as tell:
                report_or_stop = _stopping(tell, interruption)
                rounds = plan.rounds if arguments.milliseconds else 0
                shown = TrackPlan(ways, kept, REFERENCE, rounds=rounds)
                work = partial(_temporal, shown) if ways else _chart
                work(scenes, plan, outputs, arguments.context, report_or_stop)
        except KeyboardInterrupt:
            print(f"glrt: interrupted; {_left(outputs.folder)}.", file=sys.stderr)
            return INTERRUPTED + (interruption.signal or 0)
    if not arguments.quiet:
        print(written(outputs, page, [*scenes]), file=sys.stderr)
    return 0


def written(outputs: Outputs, page: str, scenes: Sequence[str]) -> str:
    """Return the sentence about the files of charts; `page`: the name of that in the folder."""
    if outputs.folder is None:
        return f"Wrote {file_names([path for path in [outputs.page] if path])}."
    pages = [outputs.folder / page, *([outputs.page] if outputs.page else [])]
    return f"Wrote {file_names(pages)} and the charts of {file_names(scenes)}."


def _left(folder: Path | None) -> str:
    """Return what an interruption leaves."""
    if folder is None:
        return "nothing is written"
    return (
        f"the rounds so far are kept in {file_names([folder])}, and the same command continues "
        "from there"
    )


def _stopping(tell: Tell, interruption: Interruption) -> Tell:
    """Wrap the progress function so that it raises KeyboardInterrupt after an interruption."""

    def report_or_stop(text: str, share: float) -> None:
        if interruption.signal is not None:
            raise KeyboardInterrupt
        tell(text, share)

    return report_or_stop


def _chart(
    scenes: dict[str, Scene], plan: Plan, outputs: Outputs, route: Choice, tell: Tell
) -> None:
    context = open_context(route)
    experiments = []
    folder = outputs.folder
    for number, (name, scene) in enumerate(scenes.items()):

        def report_all(text: str, share: float, before: int = number) -> None:
            tell(text, (before + share) / len(scenes))

        rounds = folder / f"{name}.rounds.json" if folder else None
        experiments.append(measure_scene(name, scene, plan, context, rounds, report_all))
        if folder:
            save_chart(experiments[-1], folder)
    if folder:
        method_files.save_page(experiments, folder)
    if outputs.page:
        found = [section_of(experiment) for experiment in experiments]
        save_chart_page(found, outputs.page, "Speed against accuracy", _ABOUT)


_ABOUT = (
    "Relative RMS error against a reference, by the time of all dispatches and by rays. Times are "
    f"medians; bands are 95 % intervals over the rounds. At first the charts show {MOST_SHOWN} "
    "curves at most: the baseline, the default, what --curve names, and the fastest."
)


def _temporal(
    shown: TrackPlan,
    scenes: dict[str, Scene],
    plan: Plan,
    outputs: Outputs,
    route: Choice,
    tell: Tell,
) -> None:
    context = open_context(route)
    tracks, sections = [], []
    for number, (name, scene) in enumerate(scenes.items()):

        def report_all(text: str, share: float, before: int = number) -> None:
            tell(text, (before + share) / len(scenes))

        settings = frame_of(scene, plan.height)
        found = tracks_of(name, scene, settings, context, shown, report_all)
        title = scene.title or name
        if outputs.folder:
            save_tracks(name, title, found, outputs.folder)
        tracks += found
        sections.append(motion.section_of(name, title, found))
    size = f"Pictures are {plan.height} pixels high."
    if outputs.folder:
        save_page(tracks, size, outputs.folder)
    if outputs.page:
        about = f"Relative RMS error of what is on the screen. {size}"
        save_chart_page(sections, outputs.page, "Error while something moves", about)


def _plan(arguments: argparse.Namespace) -> Plan:
    for name, (low, high) in _LIMITS.items():
        if not low <= getattr(arguments, name) <= high:
            raise UsageError(f"--{name} must be from {low:g} to {high:g}.")
    if len(named := tuple(dict.fromkeys(arguments.curve))) > MOST_NAMED:
        raise UsageError(f"--curve may be given at most {MOST_NAMED} times.")
    if named and arguments.temporal is not None:
        raise UsageError("--curve names variants of methods, and --temporal charts none: omit one.")
    if arguments.milliseconds and arguments.temporal is None:
        raise UsageError("--milliseconds times frames while something moves: give --temporal.")
    return Plan(arguments.height, arguments.rounds, arguments.seconds, named)


def _check_named(plan: Plan, scenes: dict[str, Scene]) -> None:
    """Raise UsageError if a curve that the user named is in no chart."""
    if not plan.named:
        return
    every = [v.name for scene in scenes.values() for v in plan.variants(scene)]
    if unknown := [name for name in plan.named if called(name, every) is None]:
        names = "; ".join(dict.fromkeys(every))
        raise UsageError(f"--curve {unknown[0]!r} is in none of these charts. They have: {names}.")


def _scenes(sources: Sequence[str], rules: FileRules) -> dict[str, Scene]:
    scenes: dict[str, Scene] = {}
    for source in sources:
        name = "standard-input" if source == STANDARD_INPUT else text_of(Path(source).stem)
        if name in scenes:
            raise UsageError(f"Two scenes are called {name}: their charts would share a file.")
        scenes[name], _ = load_recipe(source, rules)
    return scenes


@contextmanager
def _progress(quiet: bool) -> Iterator[Tell]:
    """Yield a function that shows a bar with a forecast on stderr; without terminal, nothing."""
    if quiet or not sys.stderr.isatty():
        yield lambda _text, _share: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("chart", total=1.0)
        yield lambda text, share: bar.update(task, description=text, completed=share)
