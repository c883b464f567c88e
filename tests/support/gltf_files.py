"""glTF files of a few things, as bytes."""

import base64
import io
import json
import struct
from typing import Any

import numpy as np
from PIL import Image

Array = np.ndarray[Any, Any]
Table = dict[str, Any]

_TYPES = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
_SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class Builder:
    """A file under construction: JSON, and the bytes of its only buffer."""

    def __init__(self) -> None:
        self.json: Table = {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": []}
        self.binary = b""

    def view(self, content: bytes, **more: Any) -> int:
        """The number of a view of some bytes."""
        self.binary = self.binary.ljust(-(-len(self.binary) // 4) * 4, b"\0")
        place = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(content)}
        self.json["bufferViews"].append({**place, **more})
        self.binary += content
        return len(self.json["bufferViews"]) - 1

    def accessor(self, rows: Any, code: str = "f4", **more: Any) -> int:
        """The number of an accessor of some rows."""
        found = np.asarray(rows).astype(f"<{code}" if code[1] != "1" else code)
        width = 1 if found.ndim == 1 else found.shape[1]
        table = {"componentType": _TYPES[code], "type": _SHAPES[width], "count": len(found)}
        view = self.view(found.tobytes())
        self.json["accessors"].append({"bufferView": view, **table, **more})
        return len(self.json["accessors"]) - 1

    def add(self, name: str, table: Table) -> int:
        """The number of an item of a list at the top."""
        self.json.setdefault(name, []).append(table)
        return len(self.json[name]) - 1

    def image(self, pixels: Array) -> int:
        """The number of a PNG image, (H, W, 3 or 4) codes."""
        view = self.view(png(pixels))
        return self.add("images", {"bufferView": view, "mimeType": "image/png"})

    def texture(self, pixels: Array, **sampler: Any) -> int:
        """The number of a texture of its own image."""
        number = self.add("samplers", sampler)
        return self.add("textures", {"source": self.image(pixels), "sampler": number})

    def shown(self, primitive: Table, **node: Any) -> int:
        """The number of a node that shows a primitive."""
        number = self.add("meshes", {"primitives": [primitive]})
        return self.add("nodes", {"mesh": number, **node})

    def glb(self) -> bytes:
        """A .glb file."""
        table = {**self.json, "buffers": [{"byteLength": len(self.binary)}]}
        text = json.dumps(table).encode()
        text = text.ljust(-(-len(text) // 4) * 4)
        binary = self.binary.ljust(-(-len(self.binary) // 4) * 4, b"\0")
        length = 12 + 8 + len(text) + 8 + len(binary)
        head = struct.pack("<4sIIII", b"glTF", 2, length, len(text), 0x4E4F534A)
        return head + text + struct.pack("<II", len(binary), 0x004E4942) + binary

    def gltf(self, uri: str | None = None) -> bytes:
        """A .gltf file, whose buffer it holds itself, or is the file of a URI."""
        held = f"data:application/octet-stream;base64,{base64.b64encode(self.binary).decode()}"
        buffer = {"byteLength": len(self.binary), "uri": held if uri is None else uri}
        return json.dumps({**self.json, "buffers": [buffer]}).encode()


def png(pixels: Array) -> bytes:
    """The content of a PNG file."""
    file = io.BytesIO()
    Image.fromarray(pixels.astype(np.uint8)).save(file, "PNG")
    return file.getvalue()


POINTS = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
SQUARE = np.array([[0, 1, 2], [0, 2, 3]])
UV = np.array([[0.0, 1], [1, 1], [1, 0], [0, 0]])
COLORS = np.array(
    [[[255, 0, 0, 255], [0, 255, 0, 128]], [[0, 0, 255, 255], [255, 255, 255, 0]]], np.uint8
)


def square(builder: Builder, **more: Any) -> Table:
    """A primitive: a square in the plane of x and y, with texture coordinates."""
    attributes = {
        "POSITION": builder.accessor(POINTS),
        "NORMAL": builder.accessor(np.tile([0.0, 0, 1], (4, 1))),
        "TEXCOORD_0": builder.accessor(UV),
    }
    return {
        "attributes": attributes,
        "indices": builder.accessor(SQUARE.ravel(), "u2"),
        **more,
    }


def textured_square(**material: Any) -> Builder:
    """A file with a square whose base colour is an image of four pixels."""
    builder = Builder()
    texture = builder.texture(COLORS, magFilter=9728)
    base = {"baseColorTexture": {"index": texture}, "metallicFactor": 0.0, "roughnessFactor": 1.0}
    number = builder.add("materials", {"name": "painted", "pbrMetallicRoughness": base, **material})
    builder.shown(square(builder, material=number))
    return builder
