"""What the programs of `python -m bench` have in common."""

import argparse
import os
import sys
from collections.abc import Callable, Iterable

from glrt import signals
from glrt.errors import GlrtError
from glrt.signals import PLAIN, handled, interrupt
from glrt.version import VERSION


def exit_code_of(work: Callable[[], int | None]) -> int:
    """Do it, and return what it returns, or 0.

    What is wrong is told in one paragraph on stderr, with the exit code of its kind; so are Ctrl-C
    and SIGTERM, which let it clean up.
    """
    try:
        with handled(interrupt):
            return work() or 0
    except GlrtError as error:
        print(f"glrt: {' '.join(str(error).split())}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt as error:
        print(f"glrt: {PLAIN}", file=sys.stderr)
        return signals.exit_code_of(error)


def machine(*renderers: str) -> str:
    """What figures were measured with."""
    return ", ".join([f"glrt {VERSION}", *renderers, f"{os.cpu_count()} processors"])


def parser_of(name: str, about: str | None) -> argparse.ArgumentParser:
    """Of `python -m bench.NAME`."""
    return argparse.ArgumentParser(prog=f"python -m bench.{name}", description=about)


def add_rounds(
    parser: argparse.ArgumentParser, size: int, rounds: int, least_rounds: int = 2
) -> None:
    """`--size` and `--rounds`, with these defaults."""
    told = f"pixels a side (default: {size})"
    parser.add_argument("--size", type=at_least(1), default=size, metavar="N", help=told)
    told = f"runs of each, {least_rounds} or more (default: {rounds})"
    rounds_type = at_least(least_rounds)
    parser.add_argument("--rounds", type=rounds_type, default=rounds, metavar="N", help=told)


def add_tables(parser: argparse.ArgumentParser, tables: Iterable[str]) -> None:
    """The names of some tables, as `tables`; all of them if none is named."""
    names = list(tables)

    def known(text: str) -> str:
        if text not in names:
            raise argparse.ArgumentTypeError(f"there is no table {text!r}")
        return text

    told = f"of {', '.join(names)} (default: all)"
    parser.add_argument("tables", nargs="*", type=known, default=names, metavar="TABLE", help=told)


def at_least(least: int) -> Callable[[str], int]:
    """The type of an option: a whole number from `least` on."""

    def number(text: str) -> int:
        if (value := int(text)) < least:
            raise argparse.ArgumentTypeError(f"{value} is less than {least}")
        return value

    return number
