"""Common parts of the programs of bench: exit codes, options, description of the machine."""

import argparse
import os
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

from glrt.core.errors import GlrtError
from glrt.core.version import VERSION
from glrt.process import signals
from glrt.process.signals import PLAIN, handled, interrupt


def exit_code_of(work: Callable[[], int | None]) -> int:
    """Call `work` and return its exit code, or 0 for None.

    Errors of glrt are printed as one paragraph on stderr and give the exit code of their class. So
    do Ctrl-C and SIGTERM, which raise KeyboardInterrupt in `work` to let it clean up.
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
    """The version of glrt, `renderers`, and the number of processors, as a line for results."""
    return ", ".join([f"glrt {VERSION}", *renderers, f"{os.cpu_count()} processors"])


def parser_of(name: str, about: str | None) -> argparse.ArgumentParser:
    """A parser for `python -m bench.NAME` with the description `about`."""
    return argparse.ArgumentParser(prog=f"python -m bench.{name}", description=about)


def add_rounds(
    parser: argparse.ArgumentParser, size: int, rounds: int, least_rounds: int = 2
) -> None:
    """Add the options `--size` and `--rounds` with these defaults."""
    told = f"pixels a side (default: {size})"
    parser.add_argument("--size", type=at_least(1), default=size, metavar="N", help=told)
    told = f"runs of each, {least_rounds} or more (default: {rounds})"
    rounds_type = at_least(least_rounds)
    parser.add_argument("--rounds", type=rounds_type, default=rounds, metavar="N", help=told)


def add_picture(
    parser: argparse.ArgumentParser, scene: str, samples: int, size: int, what: str
) -> None:
    """Add the arguments of a program that renders a scene, with these defaults, for a picture."""
    parser.add_argument("scene", nargs="?", default=scene, help=f"default: {scene}")
    told = f"default: {samples}"
    parser.add_argument("--samples", type=at_least(16), default=samples, help=told)
    parser.add_argument("--size", type=at_least(8), default=size, help=f"{what}; default: {size}")
    parser.add_argument("-o", dest="file", type=Path, metavar="FILE.jpg", help="picture to write")


def add_tables(parser: argparse.ArgumentParser, tables: Iterable[str]) -> None:
    """Add the positional argument `tables`: names of tables to make, by default all."""
    names = list(tables)

    def known(text: str) -> str:
        if text not in names:
            raise argparse.ArgumentTypeError(f"there is no table {text!r}")
        return text

    told = f"of {', '.join(names)} (default: all)"
    parser.add_argument("tables", nargs="*", type=known, default=names, metavar="TABLE", help=told)


def at_least(least: int) -> Callable[[str], int]:
    """The type of an option for whole numbers of `least` or more."""

    def number(text: str) -> int:
        if (value := int(text)) < least:
            raise argparse.ArgumentTypeError(f"{value} is less than {least}")
        return value

    return number
