"""Quote words and numbers of the user in messages: short, on one line, with the nearest match."""

from collections.abc import Iterable, Mapping
from functools import lru_cache


def number(value: float) -> str:
    """A number for a message, as short as a user would write it and never rounded."""
    short = f"{value:g}"
    return short.replace("e+", "e") if float(short) == value else repr(value)


def shortened(text: str) -> str:
    """Text of the user, fit for a message: short, on one line."""
    whole = escaped(text[:61])
    return whole if len(whole) <= 60 else whole[:57] + "..."


def escaped(text: str) -> str:
    """Text of the user, whole, with what cannot be printed as in Python: a line break is `\\n`."""
    return "".join(
        letter if letter.isprintable() else letter.encode("unicode_escape").decode()
        for letter in text
    )


def one_line(text: str) -> str:
    """Text of a library or a driver, on one line."""
    return " ".join(text.split())


def quoted(word: str) -> str:
    """A word of the user, fit for a message, in quotes."""
    return f"'{shortened(word)}'"


@lru_cache(maxsize=64)  # a mistake often repeats in thousands of objects
def nearest(word: str, known: tuple[str, ...]) -> str | None:
    """The known word that the user probably meant, if any comes near."""
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
    """Advice about a word that is none of the known ones: the nearest of them, and them all.

    `short` are other words that the user may have meant, with the known one for each.
    """
    names = tuple(known)
    near = nearest(word, tuple(short or names))
    near = short[near] if short and near else near
    question = f"; did you mean {quoted(near)}?" if near else "."
    shown = ", ".join(shortened(name) for name in names[:12])
    rest = f" and {len(names) - 12} more" if len(names) > 12 else ""
    return f"unknown {kind} {quoted(word)}{question} {owner}: {shown or 'none'}{rest}."


def counted(number: int, noun: str) -> str:
    """A number of things in words: no lamps, 1 lamp, 2 lamps."""
    return f"{number or 'no'} {noun if number == 1 else plural(noun)}"


def plural(noun: str) -> str:
    """Lamps, boxes, meshes, vertices."""
    if noun == "vertex":
        return "vertices"
    return f"{noun}{'es' if noun.endswith(('x', 'sh')) else 's'}"
