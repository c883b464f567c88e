"""Words of Mitsuba as the XML of a scene file, and the files that it names."""

from collections.abc import Iterator
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from glrt.scene.export.companions import Companions, exact_png, pfm_of, ply_of, vol_of
from glrt.scene.export.meshes import Form
from glrt.scene.export.mitsuba.words import COMMENT, MARK, Named, Pixels, Voxels, Words

VERSION = "3.0.0"  # of the format

# The elements of plug-ins.
_ELEMENTS = {
    name: element
    for element, names in {
        "integrator": "path volpathmis",
        "sensor": "perspective thinlens",
        "sampler": "independent",
        "film": "hdrfilm",
        "rfilter": "box",
        "bsdf": "twosided diffuse conductor roughconductor dielectric thindielectric "
        "roughdielectric principled mask null",
        "emitter": "area constant envmap",
        "shape": "sphere rectangle cube cylinder disk ply shapegroup instance",
        "texture": "bitmap",
        "medium": "homogeneous heterogeneous",
        "phase": "hg",
        "volume": "gridvolume",
    }.items()
    for name in names.split()
}
_VALUES = {bool: "boolean", int: "integer", float: "float", str: "string"}
_SIDES = ("interior", "exterior")  # references whose name matters
_UNNAMED = ("", "bsdf", "emitter", "sampler", "film", "rfilter", "nested", "phase", "shape")


class XmlWriter:
    """Writes the words of a scene."""

    def __init__(self, companions: Companions) -> None:
        """`companions` receives the files that the scene names."""
        self._companions = companions
        self._paths = dict[int, Words]()  # of meshes, by the identity of what they hold

    def text(self, words: Words, head: str) -> str:
        """Return the text of a scene file that begins with the comment `head`."""
        lines = [f"<!-- {_safe(head)} -->", f'<scene version="{VERSION}">']
        for value in (it for name, it in words.items() if name != "type"):
            lines += [f"    {line}" for line in self._lines("", value)]
        return "\n".join([*lines, "</scene>", ""])

    def _lines(self, key: str, value: Any) -> Iterator[str]:
        """Yield the lines of a value; its key is its name, except where Mitsuba wants none."""
        name = "" if key in _UNNAMED else f" name={quoteattr(key)}"
        if isinstance(value, Named):
            name = f" name={quoteattr(key)}" if key in _SIDES else ""
            yield f"<ref{name} id={quoteattr(value.mark)}/>"
        elif isinstance(value, np.ndarray):
            yield f"<transform{name}>"
            yield f'    <matrix value="{_numbers(value)}"/>'
            yield "</transform>"
        elif isinstance(value, list):
            yield f'<point{name} value="{_numbers(value, ", ")}"/>'
        elif not isinstance(value, dict):
            text = str(value).lower() if isinstance(value, bool) else str(value)
            yield f"<{_VALUES[type(value)]}{name} value={quoteattr(text)}/>"
        elif value["type"] == "rgb":
            yield f'<rgb{name} value="{_numbers(value["value"], ", ")}"/>'
        elif value["type"] == "look_at":
            places = zip(("origin", "target", "up"), value["places"], strict=True)
            parts = " ".join(f'{it}="{_numbers(place, ", ")}"' for it, place in places)
            yield from (f"<transform{name}>", f"    <lookat {parts}/>", "</transform>")
        else:
            yield from self._plugin(name, value)

    def _plugin(self, name: str, value: Words) -> Iterator[str]:
        words = self._filed(value)
        element, kind = _ELEMENTS[words["type"]], quoteattr(words["type"])
        if comment := words.get(COMMENT):
            yield f"<!-- {_safe(comment)} -->"
        mark = f" id={quoteattr(words[MARK])}" if MARK in words else ""
        yield f"<{element} type={kind}{mark}{name}>"
        for key, part in words.items():
            if key not in ("type", COMMENT, MARK):
                yield from (f"    {line}" for line in self._lines(key, part))
        yield f"</{element}>"

    def _filed(self, words: Words) -> Words:
        """Return words whose arrays are names of files."""
        add = self._companions.add
        if isinstance(form := words.get("form"), Form):
            rest = {key: it for key, it in words.items() if key not in ("type", "form")}
            if id(form) not in self._paths:
                path = add("mesh", ".ply", ply_of(form))
                self._paths[id(form)] = {"filename": path, "face_normals": form.normals is None}
            return {"type": "ply", **self._paths[id(form)], **rest}
        if isinstance(pixels := words.get("bitmap"), Pixels):
            rest = {key: it for key, it in words.items() if key not in ("bitmap", "raw")}
            is_texture = words["type"] == "bitmap"
            codes = exact_png(pixels.values) if is_texture and pixels.values.shape[2] == 3 else None
            suffix, content = (".png", codes) if codes else (".pfm", pfm_of(pixels.values))
            raw = {"raw": codes is None} if is_texture else {}
            return {**rest, "filename": add("image", suffix, content), **raw}
        if isinstance(voxels := words.get("grid"), Voxels):
            rest = {key: it for key, it in words.items() if key != "grid"}
            return {**rest, "filename": add("density", ".vol", vol_of(voxels.values))}
        return words


def _numbers(values: Any, between: str = " ") -> str:
    return between.join(repr(float(it) + 0.0) for it in np.ravel(values))


def _safe(text: str) -> str:
    """Return a text that a comment may hold."""
    return text.replace("--", "- -").replace("--", "- -")
