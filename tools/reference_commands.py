"""The page of commands: every argument with its help, from the parsers."""

import argparse
from collections.abc import Iterator

from reference_markdown import GENERATED, prose, table

from glrt.cli.commands import COMMANDS, make_parser
from glrt.core import errors
from glrt.process import signals


def commands() -> Iterator[str]:
    """Every command with its arguments, from the parsers."""
    yield "# Commands"
    yield GENERATED
    yield (
        "`glrt COMMAND --help` prints the same in a terminal; `glrt --version` prints the version. "
        "In a checkout the command is `.venv/bin/glrt` after `make render`. Options cannot be "
        "abbreviated."
    )
    yield table(
        ("command", "does"),
        [(f"[`glrt {name}`](#glrt-{name})", text) for name, text in COMMANDS.items()],
    )
    for name in COMMANDS:
        yield from command(name)
    yield "## Exit codes"
    yield (
        "An error is one paragraph on stderr: what is wrong, where, and what to do. Each command "
        "uses these codes."
    )
    yield table(("code", "meaning"), [(str(code), text) for code, text in exit_codes()])


def command(name: str) -> Iterator[str]:
    """One command."""
    parser = make_parser(name).commands[name]
    actions = [action for action in parser._actions if action.dest != "help"]
    positional = [action for action in actions if not action.option_strings]
    options = [action for action in actions if action.option_strings]
    required = [f"{spelled(action)}" for action in options if action.required]
    line = " ".join([f"glrt {name}", *map(place, positional), *required])
    yield f"## `glrt {name}`"
    yield prose(parser.description or "")
    yield f"```text\n{line}{' [OPTIONS]' if options else ''}\n```"
    if actions:
        rows = [(f"`{spelled(action)}`", explained(action)) for action in [*positional, *options]]
        yield table(("argument", "meaning"), rows)
    if parser.epilog:
        yield prose(parser.epilog)


def place(action: argparse.Action) -> str:
    """A positional argument in a usage line."""
    name = str(action.metavar)
    return {"?": f"[{name}]", "*": f"[{name} ...]", "+": f"{name} [{name} ...]"}.get(
        str(action.nargs), name
    )


def spelled(action: argparse.Action) -> str:
    """An option with its value."""
    if not action.option_strings:
        return str(action.metavar)
    name = " / ".join(action.option_strings)
    if action.nargs == 0 or isinstance(action, argparse.BooleanOptionalAction):
        return name
    if action.choices is not None:
        return f"{name} {'|'.join(map(str, action.choices))}"
    value = action.metavar or action.dest.upper()
    return f"{name} {value if isinstance(value, str) else ' '.join(value)}"


def explained(action: argparse.Action) -> str:
    """The help of an argument, with its default."""
    text = (action.help or "").replace("%(default)s", str(action.default)).replace("%%", "%")
    return prose(text)


def exit_codes() -> list[tuple[int, str]]:
    """Codes that commands end with."""
    return [
        (0, "done"),
        (1, "a check failed: pictures differ, a guarantee is broken, `--error` was not reached"),
        (errors.UsageError.exit_code, "a wrong command line, file or scene"),
        (errors.ContextError.exit_code, "no usable OpenGL"),
        (errors.RenderError.exit_code, "the render failed: driver, memory or disk"),
        (signals.INTERRUPTED + 1, "its terminal was closed (SIGHUP); a render saves what it has"),
        (signals.INTERRUPTED + 2, "interrupted by Ctrl-C; a render saves what it has"),
        (signals.INTERRUPTED + 15, "ended by SIGTERM; a render saves what it has"),
    ]
