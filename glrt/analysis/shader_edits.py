"""Renderers whose shaders differ from glrt's: what a choice in them gives."""

from typing import NamedTuple

from glrt.gpu.glsl import read
from glrt.rendering.renderer import Renderer


class Edit(NamedTuple):
    """Another text in place of one that stands in a shader file, once or more often."""

    file: str
    old: str
    new: str


def edited(*edits: Edit) -> type[Renderer]:
    """A renderer with these edits, in turn; `KeyError` if one has no place."""
    texts: dict[str, str] = {}
    for edit in edits:
        text = texts.get(edit.file) or read(edit.file)
        if edit.old not in text:
            raise KeyError(f"{edit.file} does not hold `{edit.old}`")
        texts[edit.file] = text.replace(edit.old, edit.new)

    class Edited(Renderer):
        """With other texts for some shader files."""

        def _parts(self) -> dict[str, str]:
            return {**super()._parts(), **texts}

    return Edited
