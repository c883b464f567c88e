"""JSON and buffer of a glTF file that is written."""

import base64
import json
import struct
from typing import Any

import numpy as np
from numpy.typing import NDArray

Table = dict[str, Any]

_FLOAT, _UNSIGNED = 5126, 5125
_SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_VERTICES, _CORNERS = 34962, 34963  # uses of a view
_MAGIC, _VERSION, _JSON, _BIN = 0x46546C67, 2, 0x4E4F534A, 0x004E4942


class GltfFile:
    """A glTF 2.0 file that grows: lists of things, and the bytes of its only buffer."""

    def __init__(self, generator: str) -> None:
        self._table: Table = {"asset": {"version": "2.0", "generator": generator}, "scene": 0}
        self._bytes = bytearray()
        self._extensions = set[str]()

    def add(self, name: str, item: Table) -> int:
        """Add an item to a list at the top; return its number."""
        items: list[Table] = self._table.setdefault(name, [])
        items.append(item)
        return len(items) - 1

    def use(self, *extensions: str) -> None:
        """List extensions that the file uses."""
        self._extensions |= set(extensions)

    def put(self, key: str, value: Any) -> None:
        """Set a key at the top."""
        self._table[key] = value

    def note(self, key: str, value: Any) -> None:
        """Set a key of the file's extras, which other programs pass over."""
        self._table["asset"].setdefault("extras", {})[key] = value

    def vertices(self, rows: NDArray[np.float64]) -> int:
        """Add numbers, (n, 1 to 4), in float32; return the number of their accessor."""
        values = np.ascontiguousarray(rows, "<f4")
        ends = {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        table = {"componentType": _FLOAT, "type": _SHAPES[values.shape[1]], "count": len(values)}
        view = self.view(values.tobytes(), _VERTICES)
        return self.add("accessors", {"bufferView": view, **table, **ends})

    def corners(self, numbers: NDArray[np.int64]) -> int:
        """Add numbers of vertices; return the number of their accessor."""
        values = np.ascontiguousarray(numbers.ravel(), "<u4")
        table = {"componentType": _UNSIGNED, "type": "SCALAR", "count": len(values)}
        view = self.view(values.tobytes(), _CORNERS)
        return self.add("accessors", {"bufferView": view, **table})

    def view(self, content: bytes, target: int | None = None) -> int:
        """Add bytes; return the number of their view."""
        self._bytes += bytes(-len(self._bytes) % 4)
        table: Table = {"buffer": 0, "byteOffset": len(self._bytes), "byteLength": len(content)}
        self._bytes += content
        return self.add("bufferViews", {**table, **({"target": target} if target else {})})

    def binary(self) -> bytes:
        """Return a .glb file."""
        text = json.dumps(self._whole({})).encode()
        text += b" " * (-len(text) % 4)
        content = bytes(self._bytes) + bytes(-len(self._bytes) % 4)
        parts = struct.pack("<II", len(text), _JSON) + text
        parts += struct.pack("<II", len(content), _BIN) + content
        return struct.pack("<III", _MAGIC, _VERSION, 12 + len(parts)) + parts

    def text(self) -> bytes:
        """Return a .gltf file, which holds its buffer itself."""
        held = base64.b64encode(bytes(self._bytes)).decode()
        uri = f"data:application/octet-stream;base64,{held}"
        return json.dumps(self._whole({"uri": uri})).encode()

    def _whole(self, buffer: Table) -> Table:
        buffers = {"buffers": [{"byteLength": len(self._bytes), **buffer}]} if self._bytes else {}
        used = {"extensionsUsed": sorted(self._extensions)} if self._extensions else {}
        return {**self._table, **buffers, **used}
