"""A bug to plant: an expression of a function, what stands in its place, the test that finds it."""

import csv
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from tests.mutation.places import Span

LIST = Path(__file__).with_name("mutants.csv")


class Mutant(NamedTuple):
    """A row of mutants.csv."""

    bug: str
    function: str  # a function, constant, struct or class of the shaders or the program
    old: str  # stands once in what has this name, whatever the spaces and the ends of lines
    new: str
    test: str  # FILE::NAME in tests/: all cases of it are run until one fails


def mutants() -> list[Mutant]:
    """All bugs of the list."""
    with LIST.open(newline="") as file:
        return [Mutant(**row) for row in csv.DictReader(file)]


def place_of(mutant: Mutant, known: Mapping[str, Sequence[Span]]) -> Span:
    """The text that the bug replaces; ValueError if it does not stand there exactly once."""
    words = [re.escape(word) for word in mutant.old.split()]
    pattern = re.compile(r"\s+".join(words))
    found = set()
    for span in known.get(mutant.function, ()):
        text = span.file.read_text()
        for match in pattern.finditer(text, span.start, span.end):
            found.add(Span(span.file, match.start(), match.end()))
    if len(found) != 1:
        raise ValueError(f"{mutant.function} has {len(found)} times: {mutant.old!r}")
    return found.pop()


def plant(mutant: Mutant, known: Mapping[str, Sequence[Span]]) -> tuple[Path, str]:
    """Put the bug into its file; returns the file, and its text as it was."""
    file, start, end = place_of(mutant, known)
    text = file.read_text()
    file.write_text(text[:start] + mutant.new + text[end:])
    return file, text
