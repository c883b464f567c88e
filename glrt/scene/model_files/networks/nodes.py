"""A node of a network, whatever file it is from."""

from typing import Any, NamedTuple, Protocol

Table = dict[str, Any]
Numbers = tuple[float, ...]


class Node(Protocol):
    """A node: its inputs have values, or are connected to outputs of other nodes."""

    @property
    def path(self) -> str:
        """Where the node stands in its file."""
        ...

    @property
    def category(self) -> str:
        """The kind of node, such as `image`."""
        ...

    @property
    def type(self) -> str:
        """The type of its output as MaterialX calls it, such as `color3`; empty if unknown."""
        ...

    def value(self, name: str) -> float | str | Numbers | None:
        """Return the value of an input; None if it has none, or is connected."""
        ...

    def source(self, name: str) -> "Source | None":
        """Return what gives an input its value; None if it is not connected."""
        ...

    def color_space(self, name: str) -> str:
        """Return the color space of an input's value; empty if the file does not say."""
        ...

    def image(self, kind: str) -> "NamedImage | None":
        """Return the image of its input `file`, for an input `kind` of a surface.

        It is None, and is reported, if the image is left out.
        """
        ...


class NamedImage(NamedTuple):
    """An image of a file."""

    number: int
    name: str

    @property
    def is_linear(self) -> bool:
        """Whether its colors are light, and no codes."""
        return self.name.lower().endswith((".exr", ".hdr"))


class Source(NamedTuple):
    """An output of a node."""

    node: Node
    output: str
