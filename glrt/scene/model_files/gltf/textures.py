"""Convert textures of a glTF file to those of a scene."""

import math
from typing import Any

from glrt.scene.model_files.gltf.document import Document, number, numbers
from glrt.scene.model_files.gltf.images import image_place

_WRAPS = {33071: "clamp", 33648: "mirror", 10497: "repeat"}
_NEAREST = 9728


class TextureTables:
    """The textures of a file as tables of a scene, `{ image, wrap, ... }`."""

    def __init__(self, document: Document, path: str, folder: str) -> None:
        """Take the path of the file in the scene, and its `folder` with '/' at the end."""
        self._document, self._path, self._folder = document, path, folder

    def table(self, given: Any, here: str) -> dict[str, Any] | None:
        """Return the table for a material's reference to a texture; None if there is none."""
        if given is None:
            return None
        document, info = self._document, self._document.table(given, here)
        texture = document.item("textures", info.get("index"), f"{here}.index")
        if "source" not in texture:
            return None  # its format needs an extension
        name = f"textures[{info['index']}]"
        place = image_place(document, texture["source"], f"{name}.source")
        file = f"{self._path}#{place.number}" if place.path is None else self._folder + place.path
        sampler = (
            document.item("samplers", texture["sampler"], f"{name}.sampler")
            if "sampler" in texture
            else {}
        )
        found: dict[str, Any] = {"image": file, **self._placing(info, here)}
        wraps = tuple(_WRAPS.get(sampler.get(key, 10497), "repeat") for key in ("wrapS", "wrapT"))
        found["wrap"] = wraps
        if sampler.get("magFilter") == _NEAREST:
            found["filter"] = "nearest"
        return found

    def _placing(self, info: dict[str, Any], here: str) -> dict[str, Any]:
        found: dict[str, Any] = {}
        own = self._document.extension(info, "KHR_texture_transform", here) or {}
        for key in ("scale", "offset"):
            if key in own:
                found[key] = numbers(own[key], 2, f"{here}: {key}")
        if "rotation" in own:
            found["rotation"] = math.degrees(
                number(own["rotation"], f"{here}: rotation", -1e4, 1e4)
            )
        uv = own.get("texCoord", info.get("texCoord", 0))
        if uv not in (0, 1) or type(uv) is not int:
            raise ValueError(f"{here}.texCoord must be 0 or 1, got {uv!r}"[:200])
        return {**found, "uv": uv}
