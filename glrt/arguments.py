"""The command line: options of a render generated from Settings, errors in one paragraph."""

import argparse
from difflib import get_close_matches
from pathlib import Path
from typing import Any, NoReturn, get_args

from glrt.context import ROUTES, Pipeline
from glrt.errors import UsageError
from glrt.settings import RenderSettings, Settings
from glrt.version import VERSION

AUTO = "auto"  # as --method: chosen by a measurement


class Parser(argparse.ArgumentParser):
    """argparse, but an error is a UsageError with a did-you-mean."""

    def __init__(self, **options: Any) -> None:
        """Abbreviations are off: a script must not change its meaning when options are added."""
        super().__init__(allow_abbrev=False, **options)

    def error(self, message: str) -> NoReturn:
        """Raise what argparse would print."""
        raise UsageError(f"{message}. See `{self.prog} --help`.")

    def parse(self, arguments: list[str] | None) -> argparse.Namespace:
        """Parse everything; an unknown option gets the nearest known one as advice."""
        result, unknown = self.parse_known_args(arguments)
        if unknown:
            raise UsageError(self._advice(unknown[0], str(result.command)))
        return result

    def _advice(self, word: str, command: str) -> str:
        options = [
            option
            for action in self._commands()[command]._actions
            for option in action.option_strings
        ]
        near = get_close_matches(word.partition("=")[0], options, n=1)
        question = f" Did you mean {near[0]}?" if near else ""
        kind = "option" if word.startswith("-") else "argument"
        return f"unknown {kind} {word!r}.{question} See `{self.prog} {command} --help`."

    def _commands(self) -> dict[str, argparse.ArgumentParser]:
        for action in self._actions:
            if isinstance(action, argparse._SubParsersAction):
                return dict(action.choices)
        return {}


def make_parser() -> Parser:
    """The parser of all commands; the result has `command` and what the command needs."""
    parser = Parser(prog="glrt", description="A path tracer in OpenGL compute shaders.")
    parser.add_argument("--version", action="version", version=f"glrt {VERSION}")
    commands = parser.add_subparsers(
        dest="command", metavar="COMMAND", required=True, parser_class=Parser
    )
    _add_render(commands.add_parser("render", help="render a scene to a file", **_HELP["render"]))
    _add_view(commands.add_parser("view", help="show a scene in a window", **_HELP["view"]))
    _add_compare(commands.add_parser("compare", help="do two renders differ", **_HELP["compare"]))
    _add_inspect(commands.add_parser("inspect", help="what a scene needs", **_HELP["inspect"]))
    _add_chart(commands.add_parser("chart", help="speed against accuracy", **_HELP["chart"]))
    _add_stress(commands.add_parser("stress", help="where methods fail", **_HELP["stress"]))
    doctor = commands.add_parser("doctor", help="which OpenGL routes work", **_HELP["doctor"])
    doctor.add_argument("--json", action="store_true", help="one line of findings on stdout")
    commands.add_parser("schema", help="the scene format as JSON Schema", **_HELP["schema"])
    return parser


_HELP: dict[str, dict[str, Any]] = {
    "render": {
        "description": "Render a scene without a window.",
        "epilog": "The first limit reached of --samples, --time and --error ends the render; "
        "--time or --error without --samples lifts the sample limit to 1048576. Ctrl-C saves "
        "what was rendered; a long render saves every minute, and --resume goes on from its .exr. "
        "Exit codes: 0 done, 1 --error not reached, 2 bad usage or scene, "
        "3 no usable OpenGL, 4 the render failed, 130 and 143 interrupted.",
    },
    "view": {
        "description": "Show a scene in a window, and tune everything live. Closing the window "
        "saves nothing but the window's own preferences; a picture is saved by its button.",
        "epilog": "Exit codes: 0 closed, 2 bad usage or scene, 3 no window or no usable OpenGL, "
        "130 and 143 interrupted.",
    },
    "compare": {
        "description": "Say whether two renders show the same picture up to their noise: same, "
        "different, or undecided for lack of samples.",
        "epilog": "At most a share ALPHA of equal pictures is called different. Exit codes: 0 same "
        "or undecided, 1 different (with --strict, undecided too), 2 bad usage or files.",
    },
    "inspect": {
        "description": "Say what the kernel for a scene contains and leaves out, and why; with "
        "--error, the cheapest method and the fewest bounces that suffice."
    },
    "chart": {
        "description": "Measure the error of every method against its time on some scenes; draw it "
        "(SVG, PNG), list it (CSV, JSON) and tell what it shows (chart.md).",
        "epilog": "The same command goes on after an interruption. References are kept in the "
        "user's cache folder. Exit codes: 0 done, 2 bad usage or scene, or no matplotlib, 3 no "
        "usable OpenGL, 4 a render failed, 130 interrupted.",
    },
    "stress": {
        "description": "Sweep into the places where methods fail: what glrt does beside the naive "
        "way, in charts and a table, with a verdict for each case.",
        "epilog": "Exit codes: 0 all guarantees hold, 1 one is broken, 2 bad usage, 3 no usable "
        "OpenGL, 4 the render failed.",
    },
    "doctor": {
        "description": "Try every OpenGL route, each in a process of its own, and say which one is "
        "used. Exit codes: 0, 3 if none works."
    },
    "schema": {"description": "Print the JSON Schema of scene files, for editors."},
}

_SCENE = "a scene file, the name of a scene that comes with glrt, or a picture rendered by glrt"


def _add_render(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "scene", metavar="SCENE", nargs="?", help=f"{_SCENE}; with --resume optional"
    )
    parser.add_argument(
        "-o",
        dest="outputs",
        metavar="FILE",
        action="append",
        required=True,
        help="the picture: .exr (radiance and its error), .png or .npy; may be repeated",
    )
    _render_settings(parser)
    parser.add_argument("--time", type=float, metavar="SECONDS", help="stop then; from the start")
    parser.add_argument(
        "--error", type=float, metavar="E", help="stop at this relative RMS error: 0.02 is 2 %%"
    )
    _add_context(parser)
    _add_pipeline(parser)
    parser.add_argument(
        "--resume",
        metavar="FILE.exr",
        help="go on from this picture, by its scene and settings, up to --samples in all",
    )
    parser.add_argument("--json", action="store_true", help="one line of figures on stdout")
    parser.add_argument("--quiet", action="store_true", help="no progress, no summary")


def _add_view(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "scene", metavar="SCENE", nargs="?", default="cornell", help=f"{_SCENE}; default: cornell"
    )
    _add_settings(parser)
    _add_pipeline(parser)


def _add_pipeline(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--pipeline",
        choices=get_args(Pipeline),
        default="auto",
        help="kind of shader; fragment needs OpenGL 4.1 alone; default: compute where it works",
    )


def _add_compare(parser: argparse.ArgumentParser) -> None:
    for name in ("image", "reference"):
        parser.add_argument(name, metavar=name.upper(), help="an .exr or .npy file")
    for name in ("samples", "reference-samples"):
        whose = "REFERENCE" if name.startswith("reference") else "IMAGE"
        text = f"samples a pixel of {whose}, if its file does not say it"
        parser.add_argument(f"--{name}", type=int, metavar="N", help=text)
    parser.add_argument(
        "--alpha", type=float, default=0.01, help="share of false alarms (default: %(default)s)"
    )
    parser.add_argument(
        "--bias",
        type=float,
        default=0.01,
        help='the relative difference that "same" must exclude (default: %(default)s)',
    )
    parser.add_argument("--strict", action="store_true", help="exit 1 if undecided, too")
    parser.add_argument("--picture", metavar="FILE", help="a .png that shows where they differ")
    parser.add_argument("--json", action="store_true", help="one line of figures on stdout")


def _add_inspect(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE", help=_SCENE)
    _add_settings(parser)
    parser.add_argument(
        "--error",
        type=float,
        metavar="E",
        help="measure which method and how many bounces suffice for this relative RMS error",
    )
    _add_context(parser)


def _add_chart(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scenes", metavar="SCENE", nargs="+", help=_SCENE)
    parser.add_argument("-o", dest="output", metavar="DIR", required=True, help="folder to fill")
    for name, default, kind, text in (
        ("height", 64, int, "height of the frame in pixels"),
        ("rounds", 5, int, "runs of each variant"),
        ("seconds", 60.0, float, "time for the rounds of a scene; its reference takes up to half"),
    ):
        metavar = "N" if kind is int else "S"
        note = f"{text} (default: {default:g})"
        parser.add_argument(f"--{name}", type=kind, default=default, metavar=metavar, help=note)
    _add_context(parser)
    parser.add_argument("--quiet", action="store_true", help="no progress, no summary")


def _add_stress(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("cases", metavar="CASE", nargs="*", help="what to try (default: everything)")
    add("-o", dest="folder", metavar="DIR", type=Path, help="folder for table and charts")
    add("--quick", action="store_true", help="fewer samples: below two minutes on two cores")
    add("--list", action="store_true", help="name the cases, and run none")
    add("--json", action="store_true", help="one line of figures on stdout")
    _add_context(parser)


def _add_context(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--context", choices=["auto", *sorted(ROUTES)], default="auto", help="OpenGL route"
    )


def _add_settings(parser: argparse.ArgumentParser) -> None:
    """An option for each field of Settings; absent ones leave no trace in the result."""
    group = parser.add_argument_group("settings")
    for name, field in Settings.model_fields.items():
        options = _options(name, field.annotation)
        wish = "the scene's" if name in RenderSettings.model_fields else field.default
        unit = (field.json_schema_extra or {}).get("unit")  # type: ignore[union-attr]
        notes = "; ".join(filter(None, [str(unit or ""), f"default: {wish}"]))
        text = f"{field.description} ({notes})".replace("%", "%%")
        group.add_argument(f"--{name}", default=argparse.SUPPRESS, help=text, **options)
    group.add_argument(
        "--light",
        dest="lights",
        metavar="GROUP=X",
        action="append",
        type=_light,
        default=[],
        help="intensity of a light group, from 0; may be repeated",
    )


def _render_settings(parser: argparse.ArgumentParser) -> None:
    """The settings, and one more value of the method."""
    _add_settings(parser)
    for action in parser._actions:
        if action.dest == "method":
            action.choices = [*(action.choices or ()), AUTO]
            action.help = (
                f"{action.help}; {AUTO}: the cheapest that reaches --error, by a measurement of "
                "some seconds, or of half of --time"
            )


def _options(name: str, annotation: Any) -> dict[str, Any]:
    if name == "crop":
        return {"nargs": 4, "type": int, "metavar": ("X", "Y", "W", "H")}
    if annotation is bool:
        return {"action": argparse.BooleanOptionalAction}
    if choices := get_args(annotation):
        return {"choices": choices}
    return {"type": annotation, "metavar": "N" if annotation is int else "EV"}


def _light(text: str) -> tuple[str, float]:
    group, equals, value = text.rpartition("=")
    try:
        return (group, float(value)) if equals and group else _refuse_light(text)
    except ValueError:
        return _refuse_light(text)


def _refuse_light(text: str) -> NoReturn:
    raise argparse.ArgumentTypeError(f"{text!r} is not GROUP=X, such as ceiling=0.5")


def settings_given(arguments: argparse.Namespace) -> dict[str, Any]:
    """The settings that stand on the command line."""
    given = {name: v for name, v in vars(arguments).items() if name in Settings.model_fields}
    return {name: value for name, value in given.items() if value != AUTO}


def is_automatic(arguments: argparse.Namespace) -> bool:
    """Whether the method is to be chosen by what the error asks for."""
    return getattr(arguments, "method", None) == AUTO
