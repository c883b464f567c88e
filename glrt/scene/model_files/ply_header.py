"""Headers of PLY files (Turk, "The PLY Polygon File Format", 1994)."""

from dataclasses import dataclass, field

from glrt.core.errors import ContentError
from glrt.core.text import quoted
from glrt.scene.model_files.text_lines import text_of

_TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "float32": "f4",
    "float64": "f8",
}
_FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_LONGEST_HEADER = 1 << 16  # bytes
_MOST = 1 << 31  # of an element


@dataclass
class Property:
    """A column: numbers, or lists of numbers."""

    name: str
    kind: str  # as numpy names it, without the order of bytes
    count: str = ""  # type of the lengths of lists; empty for numbers


@dataclass
class Element:
    """A table of the header."""

    name: str
    count: int
    properties: list[Property] = field(default_factory=list)

    @property
    def is_fixed(self) -> bool:
        """Whether all rows have the same length."""
        return not any(column.count for column in self.properties)


def header_of(content: bytes) -> tuple[str, list[Element], int]:
    """Return the order of bytes, empty for text, the elements, and where their rows begin."""
    head = content[:_LONGEST_HEADER]
    end = head.find(b"end_header")
    if not head.startswith(b"ply") or end < 0:
        raise ContentError("it does not begin with a header from `ply` to `end_header`")
    start = end + len(b"end_header")
    if content[start : start + 2] == b"\r\n":
        start += 1
    order, elements = None, list[Element]()
    for line in text_of(head[:end]).replace("\r", "\n").split("\n"):
        words = line.split()
        if words[:1] == ["format"] and len(words) > 1:
            order = _FORMATS.get(words[1])
        elif words[:1] == ["element"]:
            elements.append(_element(words))
        elif words[:1] == ["property"]:
            if not elements:
                raise ContentError("a property stands before the first element of its header")
            elements[-1].properties.append(_property(words))
    if order is None:
        raise ContentError("its header names no format that PLY files have")
    return order, elements, start + 1


def _element(words: list[str]) -> Element:
    if len(words) != len(("element", "NAME", "COUNT")) or not words[2].isdecimal():
        raise ContentError(f"its header has the element {quoted(' '.join(words[1:]))}")
    if (count := int(words[2])) > _MOST:
        raise ContentError(f"its header announces {count:,} rows of {words[1]}")
    return Element(words[1], count)


def _property(words: list[str]) -> Property:
    kinds = [_TYPES.get(word) for word in words[1:-1]]
    if len(kinds) == 1 and kinds[0]:
        return Property(words[-1], kinds[0])
    if words[1:2] == ["list"] and len(words) == len(("property", "list", "C", "T", "NAME")):
        count, kind = kinds[1:]
        if count and kind:
            return Property(words[-1], kind, count)
    raise ContentError(f"its header has the property {quoted(' '.join(words[1:]))}")
