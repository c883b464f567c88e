"""Elements of PLY files as columns (Turk, "The PLY Polygon File Format", 1994)."""

from collections.abc import Iterator
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from glrt.core.errors import ContentError
from glrt.core.text import quoted
from glrt.scene.model_files.ply_header import Element, Property, header_of
from glrt.scene.model_files.text_lines import parsed, text_of

Ints = NDArray[np.int64]

_SHOWN = 40  # letters of a word in a message


class Ragged(NamedTuple):
    """Lists of all rows one after another, and the length of each."""

    values: NDArray[Any]
    counts: Ints


Columns = dict[str, Any]  # arrays (n,), or Ragged


def tables_of(content: bytes) -> dict[str, Columns]:
    """Return the columns of each element by name; ValueError says what is wrong."""
    order, elements, start = header_of(content)
    reader: _Text | _Binary = _Binary(content, start, order) if order else _Text(content[start:])
    found = dict[str, Columns]()
    for element in elements:
        columns = reader.columns(element)
        found.setdefault(element.name, columns)
    return found


class _Binary:
    """Reads elements from bytes, one after another."""

    def __init__(self, content: bytes, start: int, order: str) -> None:
        self._content = content
        self._at = start
        self._order = order

    def columns(self, element: Element) -> Columns:
        """Return the columns of the next element."""
        least = sum(int((c.count or c.kind)[1]) for c in element.properties)
        if element.count * least > len(self._content) - self._at:
            raise _cut_off(element)
        if not element.properties:
            return {}
        if element.is_fixed:
            rows = self._rows(self._dtype(element), element)
            return {column.name: rows[column.name] for column in element.properties}
        uniform = self._uniform(element)
        return self._ragged(element) if uniform is None else uniform

    def _dtype(self, element: Element, lengths: dict[str, int] | None = None) -> np.dtype[Any]:
        fields: list[Any] = []
        for column in element.properties:
            if column.count:
                assert lengths is not None
                fields.append((f"{column.name} count", self._order + column.count))
                fields.append((column.name, self._order + column.kind, lengths[column.name]))
            else:
                fields.append((column.name, self._order + column.kind))
        try:
            return np.dtype(fields)
        except ValueError:
            raise ContentError(f"two properties of {element.name} have one name") from None

    def _rows(self, dtype: np.dtype[Any], element: Element) -> NDArray[Any]:
        if len(self._content) < self._at + element.count * dtype.itemsize:
            raise _cut_off(element)
        rows = np.frombuffer(self._content, dtype, element.count, self._at)
        self._at += element.count * dtype.itemsize
        return rows

    def _uniform(self, element: Element) -> Columns | None:
        """Return the columns if all lists are as long as those of the first row; else None."""
        start = self._at
        if not element.count:
            return {
                column.name: Ragged(np.zeros(0), np.zeros(0, np.int64)) if column.count else []
                for column in element.properties
            }
        lengths = {name: length for name, length, _ in self._row(element, start)}
        dtype = self._dtype(element, lengths)
        if len(self._content) < start + element.count * dtype.itemsize:
            return None
        rows = np.frombuffer(self._content, dtype, element.count, start)
        found: Columns = {}
        for column in element.properties:
            if column.count:
                counts = rows[f"{column.name} count"].astype(np.int64)
                if (counts != lengths[column.name]).any():
                    return None
                found[column.name] = Ragged(rows[column.name].reshape(-1), counts)
            else:
                found[column.name] = rows[column.name]
        self._at = start + element.count * dtype.itemsize
        return found

    def _row(self, element: Element, at: int) -> Iterator[tuple[str, int, int]]:
        """Yield name, length and place of the values of each property of a row."""
        for column in element.properties:
            length = 1
            if column.count:
                size = int(column.count[1])
                if at + size > len(self._content):
                    raise _cut_off(element)
                dtype = np.dtype(self._order + column.count)
                length = int(np.frombuffer(self._content, dtype, 1, at)[0])
                at += size
                if length < 0:
                    raise ContentError(f"a list of {element.name} has {length} numbers")
            yield column.name, length, at
            at += length * int(column.kind[1])
        if at > len(self._content):
            raise _cut_off(element)

    def _ragged(self, element: Element) -> Columns:
        """Return the columns of rows whose lists differ in length."""
        sizes = [int(column.kind[1]) for column in element.properties]
        lengths = np.zeros((element.count, len(sizes)), np.int64)
        starts = np.zeros((element.count, len(sizes)), np.int64)
        content, at = self._content, self._at
        order: Literal["little", "big"] = "little" if self._order == "<" else "big"
        plan = [
            (int(c.count[1]) if c.count else 0, c.count.startswith("i"), size)
            for c, size in zip(element.properties, sizes, strict=True)
        ]
        for row in range(element.count):
            for column, (prefix, is_signed, size) in enumerate(plan):
                length = 1
                if prefix:
                    word = content[at : at + prefix]
                    length = int.from_bytes(word, order, signed=is_signed)
                    at += prefix
                lengths[row, column], starts[row, column] = length, at
                at += length * size
            if at > len(content) or length < 0:
                raise _cut_off(element)
        self._at = at
        return {
            c.name: self._gathered(c, starts[:, k], lengths[:, k])
            for k, c in enumerate(element.properties)
        }

    def _gathered(self, column: Property, starts: Ints, lengths: Ints) -> Any:
        """Return the values of a property that lie anywhere in the content."""
        dtype = np.dtype(self._order + column.kind)
        first = np.cumsum(lengths) - lengths
        steps = np.arange(int(lengths.sum())) - np.repeat(first, lengths)
        at = np.repeat(starts, lengths) + steps * dtype.itemsize
        data = np.frombuffer(self._content, np.uint8)
        rows = data[at[:, None] + np.arange(dtype.itemsize)]
        values = np.ascontiguousarray(rows).view(dtype).ravel()
        return Ragged(values, lengths) if column.count else values


def _cut_off(element: Element) -> ContentError:
    return ContentError(
        f"it is cut off: it has fewer than {element.count:,} rows of {element.name}"
    )


class _Text:
    """Reads elements from words, one after another."""

    def __init__(self, content: bytes) -> None:
        text = text_of(content)
        values = parsed(text, np.float64)
        if values is None:
            wrong = next((w for w in text.split() if parsed(w, np.float64) is None), "")
            raise ContentError(f"its rows have other words than numbers: {quoted(wrong[:_SHOWN])}")
        self._values = values
        self._at = 0

    def columns(self, element: Element) -> Columns:
        """Return the columns of the next element."""
        width = len(element.properties)
        if element.is_fixed:
            rows = self._taken(element.count * width, element).reshape(element.count, width)
            return {c.name: _as_kind(rows[:, k], c) for k, c in enumerate(element.properties)}
        values: list[list[NDArray[Any]]] = [[] for _ in element.properties]
        counts: list[list[int]] = [[] for _ in element.properties]
        for _ in range(element.count):
            for k, column in enumerate(element.properties):
                length = self._length(element) if column.count else 1
                values[k].append(self._taken(length, element))
                counts[k].append(length)
        found: Columns = {}
        for k, column in enumerate(element.properties):
            joined = _as_kind(np.concatenate([np.zeros(0), *values[k]]), column)
            found[column.name] = Ragged(joined, np.array(counts[k])) if column.count else joined
        return found

    def _length(self, element: Element) -> int:
        length = float(self._taken(1, element)[0])
        if not 0 <= length <= len(self._values):
            raise ContentError(f"a list of {element.name} has {length:g} numbers")
        return int(length)

    def _taken(self, count: int, element: Element) -> NDArray[np.float64]:
        if count < 0 or self._at + count > len(self._values):
            raise _cut_off(element)
        found = self._values[self._at : self._at + count]
        self._at += count
        return found


def _as_kind(values: NDArray[np.float64], column: Property) -> NDArray[Any]:
    """Return numbers of a text as their type; ValueError for whole numbers that it cannot hold."""
    if column.kind[0] == "f":
        return values
    limits = np.iinfo(column.kind)
    wrong = ~((values >= limits.min) & (values <= limits.max))
    if wrong.any():
        value = values[int(wrong.argmax())]
        raise ContentError(f"{column.name} is {value:g}, not from {limits.min} to {limits.max}")
    return values.astype(column.kind)
