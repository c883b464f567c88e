"""Lines of model files in text, and the numbers in them."""

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import ContentError
from glrt.core.text import quoted

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_BOMS = {b"\xef\xbb\xbf": "utf-8", b"\xff\xfe": "utf-16-le", b"\xfe\xff": "utf-16-be"}
_SHOWN = 40  # letters of a line in a message


def text_of(content: bytes) -> str:
    """Return a text in UTF-8 or UTF-16; in Latin-1, if it is neither."""
    for mark, encoding in _BOMS.items():
        if content.startswith(mark):
            return content[len(mark) :].decode(encoding, "replace")
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def lines_of(content: bytes) -> list[str]:
    """Return the lines of a text, whatever ends them, without blanks around them."""
    text = text_of(content).replace("\r\n", "\n").replace("\r", "\n")
    return [line.strip() for line in text.replace("\t", " ").split("\n")]


def number_rows(texts: Sequence[str], places: Sequence[int], least: int) -> Floats:
    """Return the numbers of lines, (n, k); NaN where a line has fewer than the longest.

    `places` are the numbers of the lines, from 0. ValueError names a line with another word, or
    with fewer numbers than `least`.
    """
    counts = np.array([len(text.split()) for text in texts], np.int64)
    if len(counts) and counts.min() < least:
        line = int(counts.argmin())
        raise _bad_line(texts[line], places[line], f"fewer than {least} numbers")
    if not len(counts):
        return np.zeros((0, least))
    values = _numbers(texts, places, np.float64)
    if (counts == counts[0]).all():
        return values.reshape(len(counts), -1)
    rows = np.full((len(counts), int(counts.max())), np.nan)
    starts = np.cumsum(counts) - counts
    column = np.arange(len(values)) - np.repeat(starts, counts)
    rows[np.repeat(np.arange(len(counts)), counts), column] = values
    return rows


def whole_numbers(texts: Sequence[str], places: Sequence[int]) -> Ints:
    """Return the whole numbers of all lines one after another; ValueError names a bad line."""
    return _numbers(texts, places, np.int64)


def _numbers(texts: Sequence[str], places: Sequence[int], kind: type) -> NDArray[Any]:
    found = parsed(" ".join(texts), kind)
    if found is not None:
        return found
    for text, place in zip(texts, places, strict=True):
        if parsed(text, kind) is None:
            wanted = "whole numbers" if kind is np.int64 else "numbers"
            raise _bad_line(text, place, f"other words than {wanted}")
    raise ContentError("its numbers cannot be read")


def parsed(text: str, kind: type) -> NDArray[Any] | None:
    """Return the numbers in a text; None if there is another word in it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)  # at a word that is no number
            return np.fromstring(text, kind, sep=" ")
    except (DeprecationWarning, ValueError):
        return None


def _bad_line(text: str, place: int, problem: str) -> ContentError:
    shown = quoted(text[:_SHOWN])
    return ContentError(f"line {place + 1} has {problem}: {shown}")
