"""The parser of commands, and options generated from the models of settings."""

import argparse
import os
import re
from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, get_args

from glrt.cluster.addresses import Address, parse_address
from glrt.core.errors import UsageError
from glrt.gpu.context import ROUTES, Pipeline
from glrt.image.sources import FileRules
from glrt.settings import RenderSettings, Settings, editable_of

if TYPE_CHECKING:
    from _typeshed import SupportsWrite

AUTO = "auto"  # value of --method, --caustics or --sampler: glrt chooses
_AUTO = {  # what it chooses, by option
    "method": "the cheapest that reaches --error, measured first for some seconds, or for half of "
    "--time",
    "caustics": "as a short pilot finds it cheaper, for long renders of scenes with glass or metal",
    "sampler": "sobol64 for renders of 512 samples or more, sobol256 from 2,048 on, sobol1024 from "
    "8,192 on; sobol for shorter ones, and with --time or --error",
}
_OF_FILES = ("phong",)  # settings without an option: tables of scene files
_LEFT_OPEN = ("caustics", "sampler")  # options whose default is AUTO
SCENE = (
    "a scene file, the name of a scene that comes with glrt, a picture rendered by glrt, or - for "
    "a scene file on standard input"
)


class Parser(argparse.ArgumentParser):
    """Parser that raises UsageError with a suggestion where argparse would exit."""

    def __init__(self, **options: Any) -> None:
        """Forbid abbreviations: a script must not change its meaning when options are added."""
        super().__init__(allow_abbrev=False, **options)
        self.commands: dict[str, Parser] = {}

    def error(self, message: str) -> NoReturn:
        """Raise UsageError with the message that argparse would print."""
        raise UsageError(f"{message}. See `{self.prog} --help`.")

    def print_help(self, file: "SupportsWrite[str] | None" = None) -> None:
        """Print the help; raises OSError if that fails, which argparse would ignore."""
        print(self.format_help(), end="", file=file)

    def parse(self, arguments: list[str] | None) -> argparse.Namespace:
        """Parse a command line; UsageError for an unknown option suggests the nearest known one."""
        result, unknown = self.parse_known_args(arguments)
        if unknown:
            raise UsageError(self._advice(unknown[0], str(result.command)))
        return result

    def _advice(self, word: str, command: str) -> str:
        options = re.findall(r"--?[a-z][\w-]*", self.commands[command].format_usage())
        near = get_close_matches(word.partition("=")[0], options, n=1)
        question = f" Did you mean {near[0]}?" if near else ""
        kind = "option" if word.startswith("-") else "argument"
        return f"unknown {kind} {word!r}.{question} See `{self.prog} {command} --help`."


def add_outputs(parser: argparse.ArgumentParser) -> None:
    """Add `-o`, for a command that writes pictures."""
    parser.add_argument(
        "-o",
        dest="outputs",
        metavar="FILE",
        action="append",
        required=True,
        help="output: .exr (radiance and its standard error), .png or .npy; may be repeated",
    )


def once(outputs: Sequence[str]) -> list[str]:
    """Return the names of files without repeated ones, by the files that they lead to."""
    found = dict[str, str]()
    for name in outputs:
        try:
            place = os.path.realpath(name) if name else ""
        except OSError:  # the working folder is gone, as the writer reports
            place = name
        found.setdefault(place, name)
    return [*found.values()]


def add_summary(parser: argparse.ArgumentParser, unsaid: str) -> None:
    """Add `--json` and `--quiet`; `unsaid`: what --quiet prints, such as "no summary"."""
    parser.add_argument("--json", action="store_true", help="print figures as one line of JSON")
    parser.add_argument("--quiet", action="store_true", help=f"print {unsaid}; cautions remain")


def add_progress(parser: argparse.ArgumentParser) -> None:
    """Add `--progress`, for programs that show how far a command is."""
    parser.add_argument(
        "--progress",
        action="store_true",
        help="print the progress on standard output, two lines of JSON a second: share done, "
        "seconds to go, samples",
    )


def add_cluster(parser: argparse.ArgumentParser) -> None:
    """Add `--cluster`."""
    parser.add_argument(
        "--cluster",
        type=_cluster,
        metavar="WHERE",
        help="render on a cluster of Dask: local:N for N processes of this machine, "
        "tcp://HOST:PORT of a scheduler, or its scheduler file",
    )


def _cluster(text: str) -> Address:
    try:
        return parse_address(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def add_pipeline(parser: argparse.ArgumentParser) -> None:
    """Add `--pipeline`."""
    parser.add_argument(
        "--pipeline",
        choices=get_args(Pipeline),
        default="auto",
        help="kind of shader: compute needs OpenGL 4.3, fragment 4.1; auto: compute where it works",
    )


def add_context(parser: argparse.ArgumentParser) -> None:
    """Add `--context`."""
    parser.add_argument(
        "--context",
        choices=["auto", *sorted(ROUTES)],
        default="auto",
        help="how OpenGL is opened",
    )


def add_files(parser: argparse.ArgumentParser) -> None:
    """Add `--allow-outside`, `--assets-from` and `--assets`: which files a scene may name."""
    group = parser.add_argument_group("files that the scene names")
    group.add_argument(
        "--allow-outside",
        action="store_true",
        help="read files outside of the folder of the scene too: only for scenes that you trust",
    )
    group.add_argument(
        "--assets-from",
        type=Path,
        metavar="DIR",
        help="read them from this folder (default: that of the scene file, or of the picture)",
    )
    group.add_argument(
        "--assets",
        choices=["strict", "changed"],
        default="strict",
        help="strict: a picture takes only the files that it was made with; changed: what is there "
        "now (default: %(default)s)",
    )
    add_variant(group)


def add_variant(parser: argparse._ActionsContainer) -> None:
    """Add `--variant`, for commands that take a model."""
    parser.add_argument(
        "--variant",
        metavar="NAME",
        help="show a model with this variant of its materials (default: without a variant)",
    )


def file_rules(arguments: argparse.Namespace) -> FileRules:
    """Return the rules that the options of `add_files` set."""
    is_changed = arguments.assets == "changed"
    folder = arguments.assets_from
    return FileRules(arguments.allow_outside, folder, is_changed, arguments.variant)


def add_settings(parser: argparse.ArgumentParser, has_auto: bool = False) -> None:
    """Add `--light` and an option for each field of Settings; an option not given sets nothing.

    `has_auto`: `--method`, `--caustics` and `--sampler` also accept `auto`: glrt chooses.
    """
    group = parser.add_argument_group("settings")
    for name in Settings.model_fields:
        if name not in _OF_FILES:
            _add_setting(group, name, has_auto)
    group.add_argument(
        "--light",
        dest="lights",
        metavar="GROUP=X",
        action="append",
        type=_light,
        default=[],
        help="intensity of a light group, a factor from 0; may be repeated",
    )


def add_frame(parser: argparse.ArgumentParser) -> None:
    """Add options for the settings that files of other programs hold, too."""
    group = parser.add_argument_group("settings")
    for name in ("width", "height", "samples", "bounces", "crop"):
        _add_setting(group, name)


def _add_setting(group: argparse._ActionsContainer, name: str, has_auto: bool = False) -> None:
    field = Settings.model_fields[name]
    unit = editable_of(field).unit
    options = _options(name, field.annotation, unit)
    wish = "the scene's" if name in RenderSettings.model_fields else _shown(field.default)
    wish = AUTO if has_auto and name in _LEFT_OPEN else wish
    notes = "; ".join(filter(None, [unit, f"default: {wish}"]))
    text = f"{field.description} ({notes})".replace("%", "%%")
    if has_auto and name in _AUTO:
        options["choices"] = [*options["choices"], AUTO]
        text += f"; {AUTO}: {_AUTO[name]}"
    flag = f"--{name.replace('_', '-')}"
    group.add_argument(flag, default=argparse.SUPPRESS, help=text, **options)


def _shown(default: Any) -> str:
    """Return a default value in the words of a help text."""
    if default is None:
        return "the whole picture"
    if default == ():
        return "none"
    return ("on" if default else "off") if isinstance(default, bool) else str(default)


def _options(name: str, annotation: Any, unit: str) -> dict[str, Any]:
    if name == "crop":
        return {"nargs": 4, "type": int, "metavar": ("X", "Y", "W", "H")}
    if name in ("aov", "effects"):
        return {"type": _names, "metavar": "NAME,..."}
    if annotation is bool:
        return {"action": argparse.BooleanOptionalAction}
    if choices := get_args(annotation):
        return {"choices": choices}
    word = "X" if not unit or " " in unit else unit.upper()
    return {"type": annotation, "metavar": "N" if annotation is int else word}


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip() for name in text.split(","))


def _light(text: str) -> tuple[str, float]:
    group, equals, value = text.rpartition("=")
    try:
        return (group, float(value)) if equals and group else _refuse_light(text)
    except ValueError:
        return _refuse_light(text)


def _refuse_light(text: str) -> NoReturn:
    raise argparse.ArgumentTypeError(f"{text!r} is not GROUP=X, such as ceiling=0.5")


def error_limit(text: str) -> float:
    """Parse `--error`: a fraction of at most 1, or a percentage with its sign."""
    word = text.strip()
    try:
        share = float(word.removesuffix("%")) / (100 if word.endswith("%") else 1)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no error, such as 0.02 or 2%") from None
    if 1 < share < float("inf") and not word.endswith("%"):
        raise argparse.ArgumentTypeError(
            f"{100 * share:g} %? For {share:g} % write {share:g}% or {share / 100:g}"
        )
    return share


def settings_given(arguments: argparse.Namespace) -> dict[str, Any]:
    """Return the settings given on the command line; a value `auto` is left out."""
    given = {name: v for name, v in vars(arguments).items() if name in Settings.model_fields}
    return {n: value for n, value in given.items() if value != AUTO or n not in _AUTO}


def is_automatic(arguments: argparse.Namespace) -> bool:
    """Whether a measurement is to choose the method: `--method auto`."""
    return getattr(arguments, "method", None) == AUTO
