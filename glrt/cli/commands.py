"""The commands of `glrt` by name; each is a module of this package.

Such a module has DESCRIPTION and EPILOG for its help, `add_arguments(parser)` and
`run(arguments) -> exit code`. Only the one that is called is imported.
"""

import argparse
import sys
from importlib import import_module
from typing import Any

from glrt.cli.options import Parser
from glrt.core.version import VERSION

COMMANDS = {  # name, and what `glrt --help` says of it
    "render": "render a scene to a file",
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
    "schema": "print the scene format as JSON Schema",
}


_MODULES = {"import": "importing"}  # where a command is no name in Python


def make_parser(called: str) -> Parser:
    """The parser of all commands, with the arguments of the one that is called."""
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
    """Import the module of the command that is called, if there is one by that name."""
    if (called := _called(sys.argv[1:] if words is None else words)) in COMMANDS:
        _module(called)


def parse(words: list[str] | None = None) -> argparse.Namespace:
    """A command line, by default that of the process; SystemExit after --help and --version."""
    words = sys.argv[1:] if words is None else words
    return make_parser(_called(words)).parse(words)


def run(words: list[str] | None = None) -> int:
    """Run a command; returns its exit code."""
    try:
        arguments = parse(words)
    except SystemExit:  # after --help and --version
        return 0
    return int(_module(arguments.command).run(arguments))


def _called(words: list[str]) -> str:
    """The first word that is no option."""
    return next((word for word in words if not word.startswith("-")), "")


def _module(name: str) -> Any:
    return import_module(f"glrt.cli.{_MODULES.get(name, name)}")
