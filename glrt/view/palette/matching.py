"""Find entries by words, the best first."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from glrt.view.messages import nothing

_BEGINS, _HOLDS, _ELSEWHERE, _SCATTERED = range(4)  # how well a word fits; 0 is best


@dataclass(frozen=True)
class Entry:
    """A control or a command: its name, part of the panel, keys or value, and what Enter does.

    `more` is further text in which words are found, such as the help.
    """

    name: str
    place: str = ""
    shown: str = ""
    more: str = ""
    act: Callable[[], object] = nothing


def matches(query: str, entries: Iterable[Entry]) -> list[Entry]:
    """Return the entries that all words of a query fit, the best first; all for no words.

    A word fits best at the beginning of a word of the name, then inside the name, then in other
    texts, then as letters of the name in their order ("smpl" for "samples").
    """
    words = query.lower().split()
    found = [(rank, entry) for entry in entries if (rank := _rank(words, entry)) is not None]
    return [entry for _, entry in sorted(found, key=lambda it: it[0])]


def _rank(words: list[str], entry: Entry) -> tuple[int, int] | None:
    """Return how badly words fit, and the length of the name; None if one does not fit."""
    fits = [_fit(word, entry) for word in words]
    known = [fit for fit in fits if fit is not None]
    if len(known) < len(fits):
        return None
    return sum(known), len(entry.name) if words else 0


def _fit(word: str, entry: Entry) -> int | None:
    name = entry.name.lower()
    if any(part.startswith(word) for part in name.split()):
        return _BEGINS
    if word in name:
        return _HOLDS
    if word in f"{entry.place} {entry.shown} {entry.more}".lower():
        return _ELSEWHERE
    letters = iter(name)
    return _SCATTERED if all(letter in letters for letter in word) else None
