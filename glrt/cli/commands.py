"""The commands of `glrt` by name; each is a module of this package.

Such a module has DESCRIPTION and EPILOG for its help, `add_arguments(parser)` and
`run(arguments) -> exit code`. Only the called command is imported.
"""

import argparse
import sys
from importlib import import_module
from typing import Any

from glrt.cli.options import Parser
from glrt.core.version import VERSION

COMMANDS = {  # name, and its summary in `glrt --help`
    "render": "render a scene to a file",
    "film": "render a series of pictures",
    "view": "show a scene in a window",
    "merge": "put the parts of a render together",
    "compare": "say whether two renders differ",
    "scenes": "list the scenes that come with glrt",
    "inspect": "show what a scene holds and needs",
    "paths": "show the paths of a pixel's samples",
    "chart": "measure error against time",
    "stress": "test where methods fail",
    "doctor": "test which OpenGL routes work",
    "import": "write the scene of a model",
    "export": "write a scene as glTF, or for Mitsuba or pbrt",
    "schema": "print the scene format as JSON Schema",
}


_MODULES = {"import": "importing"}  # for commands that are keywords of Python


def make_parser(called: str) -> Parser:
    """Return the parser of all commands; only the `called` one has its arguments."""
    parser = Parser(prog="glrt", description="A path tracer in OpenGL compute shaders.")
    parser.add_argument("--version", action="version", version=f"glrt {VERSION}")
    commands = parser.add_subparsers(
        dest="command", metavar="COMMAND", required=True, parser_class=Parser
    )
    for name, summary in COMMANDS.items():
        command = _module(name) if name == called else None
        about = {"description": command.DESCRIPTION, "epilog": command.EPILOG} if command else {}
        parser.commands[name] = commands.add_parser(name, help=summary, **about)
        if command:
            command.add_arguments(parser.commands[name])
    return parser


def load(words: list[str] | None = None) -> None:
    """Import the module of the called command, if such a command exists."""
    if (called := _called(sys.argv[1:] if words is None else words)) in COMMANDS:
        _module(called)


def parse(words: list[str] | None = None) -> argparse.Namespace:
    """Parse `words`, by default the command line, and keep them; SystemExit after --help."""
    words = sys.argv[1:] if words is None else words
    arguments = make_parser(_called(words)).parse(words)
    arguments.words = words
    return arguments


def run(words: list[str] | None = None) -> int:
    """Run the command in `words`, by default the command line; return its exit code."""
    try:
        arguments = parse(words)
    except SystemExit:  # after --help and --version
        return 0
    return int(_module(arguments.command).run(arguments))


def _called(words: list[str]) -> str:
    """Return the first word that is not an option, or ""; options begin with a dash."""
    return next((word for word in words if not word.startswith("-")), "")


def _module(name: str) -> Any:
    return import_module(f"glrt.cli.{_MODULES.get(name, name)}")
