"""`glrt doctor`: test which OpenGL routes work here."""

import argparse

DESCRIPTION = (
    "Test every OpenGL route in a process of its own; say which one is used, and what to install "
    "where none works. Exit codes: 0, 3 if none works."
)
EPILOG = ""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to its parser."""
    parser.add_argument("--json", action="store_true", help="print findings as one line of JSON")


def run(arguments: argparse.Namespace) -> int:
    """Print the report of all routes; return exit code 3 if none works."""
    from glrt.doctor.report import report

    text, works = report(arguments.json)
    print(text)
    return 0 if works else 3
