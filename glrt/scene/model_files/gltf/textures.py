"""Textures of a glTF file as tables of a scene."""

import math
from typing import Any

from glrt.scene.model_files.gltf.coordinates import name_of, set_of, sets_of
from glrt.scene.model_files.gltf.document import Document, number, numbers
from glrt.scene.model_files.gltf.images import image_place

_WRAPS = {33071: "clamp", 33648: "mirror", 10497: "repeat"}
_NEAREST = 9728


class TextureTables:
    """The textures of a file as tables of a scene, `{ image, wrap, ... }`."""

    def __init__(self, document: Document, path: str, folder: str) -> None:
        """Take the path of the file in the scene, and its `folder` with '/' at the end."""
        self._document, self._path, self._folder = document, path, folder
        self.spares: dict[str, str] = {}  # shown for unreadable images
        self.left_out: list[str] = []  # textures of the material that is read, in words

    def table(self, given: Any, here: str) -> dict[str, Any] | None:
        """Return the table for a material's reference to a texture; None if there is none."""
        if given is None:
            return None
        document, info = self._document, self._document.table(given, here)
        texture = document.item("textures", info.get("index"), f"{here}.index")
        name = f"textures[{info['index']}]"
        file = self._image(texture, name)
        if file is None:
            return None  # its format needs an extension
        sampler = (
            document.item("samplers", texture["sampler"], f"{name}.sampler")
            if "sampler" in texture
            else {}
        )
        uv = self._set(info, here)
        if uv is None:
            return None
        found: dict[str, Any] = {"image": file, **self._placing(info, here), "uv": uv}
        found["wrap"] = tuple(_wrap(sampler.get(key)) for key in ("wrapS", "wrapT"))
        if sampler.get("magFilter") == _NEAREST:
            found["filter"] = "nearest"
        return found

    def _set(self, info: dict[str, Any], here: str) -> int | None:
        """Return which set of a mesh a texture lies by; None if the mesh does not hold it."""
        number, sets = set_of(self._document, info, here), sets_of(self._document)
        is_missing = bool(sets.there) and number not in sets.there
        if number in sets.kept and not is_missing:
            return sets.kept.index(number)
        reason = "which is missing" if is_missing else "a third set"
        self.left_out.append(f"{here.split('.')[-1]} by {name_of(number)}, {reason}")
        return None

    def _image(self, texture: dict[str, Any], name: str) -> str | None:
        """Return the path of the image of a texture: WebP where there is one."""
        own = self._document.extension(texture, "EXT_texture_webp", name) or {}
        files = list[str]()
        for table in (own, texture):
            if "source" in table:
                place = image_place(self._document, table["source"], f"{name}.source")
                inside = f"{self._path}#{place.number}"
                files.append(inside if place.path is None else self._folder + place.path)
        if len(files) > 1:
            self.spares[files[0]] = files[1]
        return files[0] if files else None

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
        return found


def _wrap(code: Any) -> str:
    """Return what lies beyond the edges of an image; a code of none of the kinds is the usual."""
    return next((word for known, word in _WRAPS.items() if known == code), "repeat")
