"""Add and remove objects in the text of a scene file, each with the comment above it."""

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from typing import Any

Table = Mapping[str, Any]
Pairs = list[tuple[int | None, int]]  # number before, None for a new object, and number after

_HEADER = re.compile(r"\s*\[\[\s*objects\s*\]\]\s*(#.*)?$")
_OTHER_TABLE = re.compile(r"\s*\[\[?\s*[^\s\[\],=0-9][^\[\],=]*\]\]?\s*(#.*)?$")


def with_as_many(
    text: str, before: Sequence[Table], after: Sequence[Table], new: Sequence[str]
) -> tuple[str, list[Table]]:
    """Return the text of a scene file with objects removed and added, and its objects as tables.

    `before` and `after` are all objects as tables, `new` a text for each object of `after` as if it
    were new. Tables of objects that stay are as before. A text that does not write its objects as
    `[[objects]]` stays as it is.
    """
    lines = text.splitlines(keepends=True)
    spans = list(_spans(lines))
    pairs = paired(before, after)
    stays = pairs == [(number, number) for number in range(len(before))]
    if stays or len(spans) != len(before):
        return text, list(before)
    kept = {old for old, _ in pairs}
    ending = "\r\n" if lines and lines[0].endswith("\r\n") else "\n"
    result, place = list[str](), 0
    coming = _coming(pairs, [item.replace("\n", ending) for item in new])
    if not spans:
        return _ended(text, ending) + "".join(coming.get(None, [])), list(after)
    for number, (start, end) in enumerate(spans):
        result += lines[place:start]
        if number == 0:
            result += coming.get(None, [])
        result += lines[start:end] if number in kept else []
        if number in coming:
            result[-1] = _ended(result[-1], ending)
            result += coming[number]
        place = end if number in kept else _after_blank(lines, end)
    told = [after[j] if i is None else before[i] for i, j in pairs]
    return "".join([*result, *lines[place:]]), told


def paired(before: Sequence[Table], after: Sequence[Table]) -> Pairs:
    """Pair each object of `after` with the object of `before` that it was, both in their order."""
    found = dict(_paired([_text(t) for t in after], [_text(t) for t in before]))
    pairs = Pairs()
    last = 0
    for number in [*range(len(after)), len(after)]:
        if number not in found and number < len(after):
            continue
        low, high = (pairs[-1][1] + 1 if pairs else 0), number
        until = found.get(number, len(before))
        pairs += _in_gap(before, after, range(last, until), range(low, high))
        if number < len(after):
            pairs.append((until, number))
            last = until + 1
    return pairs


def _in_gap(before: Sequence[Table], after: Sequence[Table], old: range, new: range) -> Pairs:
    """Pair objects between two that did not change, by kind, name and material.

    With as many on both sides, all are paired.
    """
    if len(old) == len(new):
        return list(zip(old, new, strict=True))
    marks = [[_mark(table[n]) for n in part] for table, part in ((after, new), (before, old))]
    found = dict(_paired(*marks))
    return [(old[found[k]] if k in found else None, n) for k, n in enumerate(new)]


def _paired(after: list[str], before: list[str]) -> Iterator[tuple[int, int]]:
    """Yield the numbers of equal texts, in the order of both lists."""
    for a, b, count in SequenceMatcher(None, after, before, autojunk=False).get_matching_blocks():
        yield from ((a + k, b + k) for k in range(count))


def _text(table: Table) -> str:
    return json.dumps(table, sort_keys=True)


def _mark(table: Table) -> str:
    return _text({key: table.get(key) for key in ("shape", "name", "material")})


def _coming(pairs: Pairs, new: list[str]) -> dict[int | None, list[str]]:
    """Return texts of new objects, by the number before behind which they stand; None: in front."""
    coming: dict[int | None, list[str]] = {}
    behind = None
    for old, number in pairs:
        if old is None:
            coming.setdefault(behind, []).append(new[number])
        else:
            behind = old
    return coming


def _spans(lines: list[str]) -> Iterator[tuple[int, int]]:
    """Yield first line and line after the last of each object, with the comment right above it."""
    number = 0
    while number < len(lines):
        if not _HEADER.match(lines[number]):
            number += 1
            continue
        start, end = number, number + 1
        while start and lines[start - 1].lstrip().startswith("#"):
            start -= 1
        number += 1
        while number < len(lines) and not _OTHER_TABLE.match(lines[number]):
            is_said = lines[number].strip() and not lines[number].lstrip().startswith("#")
            end = number + 1 if is_said else end
            number += 1
        yield start, end


def _after_blank(lines: list[str], number: int) -> int:
    """Return the line after a blank one, which separated a removed object from what follows."""
    is_blank = number < len(lines) and not lines[number].strip()
    return number + 1 if is_blank else number


def _ended(text: str, ending: str) -> str:
    return text if not text or text.endswith("\n") else text + ending
