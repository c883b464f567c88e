"""The parts of a glTF file: JSON and buffers, each checked when it is asked for."""

import base64
import binascii
import json
import struct
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from typing import Any, TypeVar
from urllib.parse import unquote_to_bytes

from glrt.core.errors import ContentError
from glrt.core.text import quoted
from glrt.scene.files.path_text import text_of_bytes

Made = TypeVar("Made")
Fetch = Callable[[str], bytes]  # the content of a file by its path from this one

KNOWN = {  # extensions that are read, or change nothing here
    "KHR_draco_mesh_compression",
    "KHR_mesh_quantization",
    "KHR_materials_ior",
    "KHR_materials_unlit",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_clearcoat",
    "KHR_materials_anisotropy",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_variants",
    "KHR_texture_transform",
    "KHR_lights_punctual",
    "EXT_texture_webp",
    # without an effect on a picture: metadata, and what a user may touch
    "KHR_xmp_json_ld",
    "KHR_xmp",
    "EXT_structural_metadata",
    "EXT_mesh_features",
    "EXT_feature_metadata",
    "AGI_articulations",
    "AGI_stk_metadata",
    "KHR_node_selectability",
    "KHR_node_hoverability",
    "GODOT_single_root",
}
_MAGIC, _JSON, _BIN = 0x46546C67, 0x4E4F534A, 0x004E4942
_LONGEST_JSON = 256 << 20  # bytes
_WHOLE = 2**53  # below it a float64 holds every whole number


class LacksExtensionError(ContentError):
    """A file requires an extension that glrt does not read; the message names it."""


class Document:
    """A glTF file; mistakes in it raise ValueError, which says where."""

    def __init__(self, content: bytes, fetch: Fetch) -> None:
        """Parse the content of a .glb or .gltf file; `fetch` brings other files."""
        text, self._binary = _chunks(content)
        self._fetch, self._buffers = fetch, dict[int, bytes]()
        self._made = dict[str, Any]()
        self.json = _parsed(text)
        version = self.table(self.json.get("asset", {}), "asset").get("version")
        if not isinstance(version, str) or not version.startswith("2."):
            raise ContentError(f"asset.version must be 2.0, got {_shown(version)}")
        needed = self.json.get("extensionsRequired", [])
        _check_extensions(needed if isinstance(needed, list) else [])

    def once(self, name: str, make: Callable[[], Made]) -> Made:
        """Return what `make` returned when it was first asked for by a name."""
        if name not in self._made:
            self._made[name] = make()
        found: Made = self._made[name]
        return found

    @cached_property
    def unknown_extensions(self) -> list[str]:
        """Names of extensions that the file uses and glrt leaves out, sorted."""
        used = self.json.get("extensionsUsed", [])
        names = [name for name in used if isinstance(name, str)] if isinstance(used, list) else []
        return sorted(set(names) - KNOWN)

    def items(self, name: str) -> list[Any]:
        """Return the list of a name at the top, `nodes` or `meshes`; empty without it."""
        return self.list(self.json.get(name, []), name)

    def item(self, name: str, index: Any, where: str) -> dict[str, Any]:
        """Return an item of a list at the top; ValueError if it is missing or no table."""
        items = self.items(name)
        if type(index) is not int or not 0 <= index < len(items):
            there = f"there are {len(items)}, numbered from 0"
            raise ContentError(f"{where} names {name}[{_shown(index)}], and {there}")
        return self.table(items[index], f"{name}[{index}]")

    @staticmethod
    def list(value: Any, where: str) -> list[Any]:
        """Return the value, which must be a list; else ValueError."""
        if not isinstance(value, list):
            raise ContentError(f"{where} must be a list, got {_shown(value)}")
        return value

    @staticmethod
    def table(value: Any, where: str) -> dict[str, Any]:
        """Return the value, which must be a table; else ValueError."""
        if not isinstance(value, dict):
            raise ContentError(f"{where} must be a table, got {_shown(value)}")
        return value

    def extension(self, table: Mapping[str, Any], name: str, where: str) -> dict[str, Any] | None:
        """Return the table of an extension in a table; None if there is none."""
        extensions = self.table(table.get("extensions", {}), f"{where}.extensions")
        if name not in extensions:
            return None
        return self.table(extensions[name], f"{where}.extensions.{name}")

    def view(self, index: Any, where: str) -> tuple[memoryview, int]:
        """Return the bytes of a view of a buffer, and the stride that it states or 0."""
        view, here = self.item("bufferViews", index, where), f"bufferViews[{index}]"
        buffer = self._buffer(view.get("buffer"), here)
        start = whole(view.get("byteOffset", 0), f"{here}.byteOffset")
        length = whole(view.get("byteLength"), f"{here}.byteLength")
        if start + length > len(buffer):
            raise ContentError(f"{here} ends after its buffer, which has {len(buffer):,} bytes")
        stride = whole(view.get("byteStride", 0), f"{here}.byteStride")
        return memoryview(buffer)[start : start + length], stride

    def content(self, uri: Any, where: str) -> bytes:
        """Return the content that a URI holds or names."""
        if not isinstance(uri, str):
            raise ContentError(f"{where} must be a text, got {_shown(uri)}")
        if uri.startswith("data:"):
            return _data(uri, where)
        return self._fetch(path_of(uri, where))

    def _buffer(self, index: Any, where: str) -> bytes:
        buffer, here = self.item("buffers", index, where), f"buffers[{index}]"
        if index not in self._buffers:
            if "uri" in buffer:
                content = self.content(buffer["uri"], f"{here}.uri")
            elif self._binary is not None and index == 0:
                content = self._binary
            else:
                raise ContentError(f"{here} has no uri, and there is no binary part for it")
            length = whole(buffer.get("byteLength"), f"{here}.byteLength")
            if length > len(content):
                raise ContentError(f"{here} has {len(content):,} bytes, and states {length:,}")
            self._buffers[index] = content
        return self._buffers[index]


def path_of(uri: str, where: str) -> str:
    """Return the path that a URI stands for; ValueError for a web address."""
    if "://" in uri:
        raise ContentError(f"{where} is a web address, and glrt loads nothing from there")
    try:
        return text_of_bytes(unquote_to_bytes(uri))
    except UnicodeEncodeError:
        raise ContentError(f"{where}: no file can have the name {quoted(uri)}") from None


def whole(value: Any, where: str, least: int = 0) -> int:
    """Return the value, which must be a whole number of at least `least`; else ValueError."""
    if type(value) is not int or not least <= value < 1 << 40:
        raise ContentError(
            f"{where} must be a whole number of at least {least}, got {_shown(value)}"
        )
    return value


def number(value: Any, where: str, low: float = -1e15, high: float = 1e15) -> float:
    """Return the value, which must be a number from `low` to `high`; else ValueError."""
    if type(value) not in (int, float) or not low <= value <= high:
        raise ContentError(
            f"{where} must be a number from {low:g} to {high:g}, got {_shown(value)}"
        )
    return float(value)


def numbers(
    value: Any, count: int, where: str, low: float = -1e15, high: float = 1e15
) -> tuple[float, ...]:
    """Return `count` numbers, each from `low` to `high`; else ValueError."""
    if not isinstance(value, list) or len(value) != count:
        raise ContentError(f"{where} must be a list of {count} numbers, got {_shown(value)}")
    return tuple(number(each, f"{where}[{place}]", low, high) for place, each in enumerate(value))


def _check_extensions(needed: list[Any]) -> None:
    lacking = [it for it in needed if not (isinstance(it, str) and it in KNOWN)]
    if lacking:
        noun = "the extension" if len(lacking) == 1 else "the extensions"
        names = ", ".join(map(_shown, lacking))
        raise LacksExtensionError(f"requires {noun} {names}, which glrt does not read")


def _chunks(content: bytes) -> tuple[bytes, bytes | None]:
    """Return the JSON and the binary part, or None for the latter."""
    if content[:4] != b"glTF":
        return content, None
    if len(content) < 12:
        raise ContentError("it ends within its header")
    _, version, length = struct.unpack_from("<III", content)
    if version != 2:
        raise ContentError(f"it is of version {version} of the binary format, and glrt reads 2")
    if length > len(content):
        raise ContentError(f"it has {len(content):,} bytes, and states {length:,}")
    found = list(_parts(content[:length]))
    if not found or found[0][0] != _JSON:
        raise ContentError("its first part is not JSON")
    binary = next((part for kind, part in found[1:] if kind == _BIN), None)
    return found[0][1], binary


def _parts(content: bytes) -> Iterator[tuple[int, bytes]]:
    place = 12
    while place + 8 <= len(content):
        length, kind = struct.unpack_from("<II", content, place)
        if place + 8 + length > len(content):
            raise ContentError("a part of it ends after the file")
        yield kind, content[place + 8 : place + 8 + length]
        place += 8 + length


def _parsed(text: bytes) -> dict[str, Any]:
    if len(text) > _LONGEST_JSON:
        raise ContentError(f"its JSON is longer than {_LONGEST_JSON >> 20} MiB")
    try:
        plain = text.rstrip(b"\0").decode("utf-8-sig")
        found = json.loads(plain, parse_constant=_refused, parse_float=_plain_number)
    except RecursionError:
        raise ContentError("its JSON is nested too deeply") from None
    except UnicodeDecodeError:
        raise ContentError("its JSON is not in UTF-8") from None
    except json.JSONDecodeError as error:
        place = f"line {error.lineno}, column {error.colno}"
        rest = quoted(plain[error.pos : error.pos + 20].partition("\n")[0])
        raise ContentError(f"its JSON is wrong in {place}, at {rest}") from None
    if not isinstance(found, dict):
        raise ContentError("its JSON is no table")
    return found


def _plain_number(word: str) -> float:
    """Return a number of JSON, whose schema takes 4.0 for a whole number."""
    value = float(word)
    return int(value) if abs(value) < _WHOLE and value.is_integer() else value


def _refused(word: str) -> Any:
    raise ContentError(f"its JSON holds {word}, which is no number")


def _data(uri: str, where: str) -> bytes:
    head, comma, body = uri.partition(",")
    if not comma or not head.endswith(";base64"):
        raise ContentError(f"{where} is a data URI without ';base64,'")
    try:
        plain = "".join(body.split()).rstrip("=")  # some files have lines, or lack the padding
        return base64.b64decode(plain + "=" * (-len(plain) % 4), validate=True)
    except binascii.Error:
        raise ContentError(f"{where} is damaged base64") from None


def _shown(value: Any) -> str:
    if isinstance(value, str):
        return quoted(value[:60])
    if isinstance(value, list | dict):
        return "a list" if isinstance(value, list) else "a table"
    return "nothing" if value is None else f"{value!r}"[:40]
