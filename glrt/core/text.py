"""Format words and numbers of the user for messages: short, on one line, with suggestions."""

from collections.abc import Iterable, Mapping
from functools import lru_cache


def number(value: float) -> str:
    """Format a number for a message: as short as a user would write it, and never rounded."""
    short = f"{value:g}"
    return short.replace("e+", "e") if float(short) == value else repr(value)


def shortened(text: str) -> str:
    """Return text of the user for a message: on one line, of at most 60 characters."""
    whole = escaped(text[:61])
    return whole if len(whole) <= 60 else whole[:57] + "..."


def escaped(text: str) -> str:
    """Return the text with unprintable characters escaped as in Python: a line break is `\\n`."""
    return "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode()
        for letter in text
    )


def one_line(text: str) -> str:
    """Return text of a library or a driver on one line, with single blanks."""
    return " ".join(text.split())


def quoted(word: str) -> str:
    """Return a word of the user in quotes, shortened for a message."""
    return f"'{shortened(word)}'"


@lru_cache(maxsize=64)  # a mistake often repeats in thousands of objects
def nearest(word: str, known: tuple[str, ...]) -> str | None:
    """Return the known word that the user probably meant; None if none is similar."""
    from difflib import get_close_matches

    near = get_close_matches(word.lower(), known, n=1)
    return near[0] if near else None


def unknown(
    kind: str,
    word: str,
    known: Iterable[str],
    owner: str = "The scene has",
    short: Mapping[str, str] | None = None,
) -> str:
    """Return advice about an unknown word: the nearest known word, and a list of the known ones.

    `short` maps other words that the user may have meant to known words.
    """
    names = tuple(known)
    near = nearest(word, tuple(short or names))
    near = short[near] if short and near else near
    question = f"; did you mean {quoted(near)}?" if near else "."
    shown = ", ".join(shortened(name) for name in names[:12])
    rest = f" and {len(names) - 12} more" if len(names) > 12 else ""
    return f"unknown {kind} {quoted(word)}{question} {owner}: {shown or 'none'}{rest}."


def counted(number: int, noun: str) -> str:
    """Return a number of things in words: no lamps, 1 lamp, 2 lamps."""
    return f"{number or 'no'} {noun if number == 1 else plural(noun)}"


def plural(noun: str) -> str:
    """Return the plural of a noun: lamps, boxes, meshes, vertices."""
    if noun == "vertex":
        return "vertices"
    return f"{noun}{'es' if noun.endswith(('s', 'x', 'sh')) else 's'}"
