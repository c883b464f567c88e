"""Nodes of a MaterialX document, as nodes of a network."""

import os
from collections.abc import Callable
from dataclasses import dataclass

import MaterialX

from glrt.scene.model_files.networks.nodes import NamedImage, Numbers, Source

Images = Callable[[str, str], NamedImage | None]  # by a path, for an input of a surface
_MOST_LINKS = 32  # from an input of a node to that of a graph


@dataclass(frozen=True)
class DocumentNode:
    """A node of a document."""

    node: MaterialX.Node
    images: Images

    @property
    def path(self) -> str:
        """The names of the graphs in which it stands, and its own."""
        return str(self.node.getNamePath())

    @property
    def category(self) -> str:
        """The kind of node, such as `image`."""
        return str(self.node.getCategory())

    @property
    def type(self) -> str:
        """The type of its output."""
        return str(self.node.getType())

    def _input(self, name: str) -> MaterialX.Input | None:
        """Return an input, or that of the graph around the node which gives its value."""
        found = self.node.getInput(name)
        for _ in range(_MOST_LINKS):
            outer = found.getInterfaceInput() if found and found.hasInterfaceName() else None
            if outer is None:
                return found
            found = outer
        return None

    def value(self, name: str) -> float | str | Numbers | None:
        """Return the value of an input."""
        found = self._input(name)
        if found is None or self.source(name) is not None:
            return None
        given = found.getValue()
        if isinstance(given, bool | int | float):
            return float(given)
        if given is None or isinstance(given, str):
            return given
        try:
            return tuple(float(each) for each in given)
        except (TypeError, ValueError):
            return None

    def source(self, name: str) -> Source | None:
        """Return the output to which an input is connected."""
        found = self._input(name)
        if found is None:
            return None
        output = found.getConnectedOutput()
        node = output.getConnectedNode() if output else found.getConnectedNode()
        if node is None:
            return None
        port = output if output and output.getParent().isA(MaterialX.NodeGraph) else found
        return Source(DocumentNode(node, self.images), str(port.getOutputString()))

    def color_space(self, name: str) -> str:
        """Return the color space of an input, or of what stands around it."""
        found = self._input(name)
        return str(found.getActiveColorSpace()) if found else ""

    def image(self, kind: str) -> NamedImage | None:
        """Return the image of a texture, from the folder of its document."""
        found = self._input("file")
        path = found.getResolvedValueString() if found else ""
        if found is None or not path:
            return self.images("", kind)
        return self.images(os.path.join(os.path.dirname(found.getActiveSourceUri()), path), kind)
